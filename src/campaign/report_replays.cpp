#include "campaign/report_replays.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "campaign/detail/replay_trips.hpp"
#include "campaign/stored_folder.hpp"
#include "campaign/worker_jobs.hpp"
#include "core/counted.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "report/read_facts.hpp"
#include "scenario/config.hpp"
#include "trace/recording.hpp"
#include "view/drawing.hpp"
#include "view/near_path.hpp"
#include "view/player.hpp"
#include "view/recorded_run.hpp"

namespace clearway::campaign {
namespace {

constexpr std::size_t most_bytes = 4'000'000;
/// Shown before the first departure and after the last arrival, s.
constexpr double margin_s = 5.0;

/// How much of a trip is shown: the first that fits.
struct Detail {
    double period_s, radius_m;
};
constexpr std::array details = {Detail{0.5, 300.0}, Detail{1.0, 200.0}, Detail{1.0, 100.0},
                                Detail{2.0, 75.0}};

std::filesystem::path replays_file(const results::Store& store) {
    return store.folder() / "replays.html";
}

/// Says to which trips, results and page a file belongs.
std::string mark_of(const std::vector<Trip>& trips) {
    std::string words = view::script_source();
    for (const Trip& trip : trips)
        words += fmt::format("\n{} {} {} {} {} {} {}", experiment::to_text(trip.baseline), trip.baseline_hash,
                             experiment::to_text(trip.condition), trip.condition_hash, trip.vehicle,
                             trip.baseline_title, trip.condition_title);
    return fmt::format("<!-- clearway replays {} -->\n", core::content_hash(words));
}

/// Runs that have to be made again, and are not recorded for good.
class MissingRecordings {
  public:
    MissingRecordings(const results::Store& store, const std::vector<Trip>& trips) : store_(store) {
        for (const Trip& trip : trips) {
            need(trip.baseline);
            need(trip.condition);
        }
    }
    ~MissingRecordings() {
        std::error_code ignored;
        for (const experiment::RunKey& key : made_)
            std::filesystem::remove(trace::recording_file(store_.folder(), key), ignored);
        for (const WorkerJob& job : jobs_) {
            std::filesystem::remove(job.file, ignored);
            std::filesystem::remove(job.log, ignored);
        }
        remove_empty_folders();
    }
    MissingRecordings(const MissingRecordings&) = delete;
    MissingRecordings& operator=(const MissingRecordings&) = delete;

    /// Throws core::Error when a run cannot be made or differs from the stored one.
    void make() {
        if (jobs_.empty()) return;
        fmt::print(stderr, "clearway: repeating {} for the replays of the report\n",
                   core::counted(made_.size(), "run"));
        const WorkerResult result = work_on(jobs_, 0, "replays");
        if (result.exit_code != core::ExitCode::ok)
            throw core::Error(result.exit_code, "the replays of the report could not be made");
    }

  private:
    void need(const experiment::RunKey& key) {
        const std::filesystem::path folder = std::filesystem::absolute(store_.folder());
        if (std::filesystem::exists(trace::recording_file(folder, key)) || core::contains(made_, key)) return;
        made_.push_back(key);
        const std::string name =
            fmt::format("replay-{}-{:05}-{}", key.scenario, key.replication, key.condition);
        experiment::RunJob job = stored_job(store_, key, folder);
        job.conditions = {with_files_found(job.conditions.front(), store_.folder())};
        job.recording = experiment::StepRecording::on;
        jobs_.push_back({.label = experiment::to_text(key),
                         .job = job,
                         .file = store_.unit_file(name),
                         .log = store_.log_file(name),
                         .work = {folder / "work" / name}});
    }
    void remove_empty_folders() const {
        std::error_code ignored;
        for (const experiment::RunKey& key : made_) {
            std::filesystem::path folder = trace::recording_file(store_.folder(), key).parent_path();
            while (folder != store_.folder() && std::filesystem::remove(folder, ignored))
                folder = folder.parent_path();
        }
    }

    const results::Store& store_;
    std::vector<experiment::RunKey> made_;
    std::vector<WorkerJob> jobs_;
};

class Plays {
  public:
    explicit Plays(const results::Store& store) : store_(store) {}

    view::PlayList list(const std::vector<Trip>& trips, const Detail& detail) {
        view::PlayList list;
        std::map<std::string, std::size_t> drawings;
        for (const Trip& trip : trips) {
            const roads::Network& network = network_of(trip.condition.scenario);
            const auto [at, is_new] = drawings.try_emplace(trip.condition.scenario, list.drawings.size());
            if (is_new) list.drawings.push_back(view::drawing_of(network));
            list.plays.push_back(play(trip, detail, network, at->second));
        }
        return list;
    }

  private:
    view::Play play(const Trip& trip, const Detail& detail, const roads::Network& network,
                    std::size_t drawing) {
        std::vector<roads::Point> path;
        for (const experiment::RunKey& key : {trip.baseline, trip.condition})
            view::add_path(trace::recording_file(store_.folder(), key), trip.vehicle, path);
        const view::Area area = view::near_path(path, detail.radius_m);
        view::Play play{
            .title = trip.title(),
            .note = fmt::format("The replay shows the surroundings of the trip up to {:g} m, every {:g} s, "
                                "interpolated in between. clearway replay --view shows a whole run.",
                                detail.radius_m, detail.period_s),
            .drawing = drawing,
            .runs = {},
            .followed = trip.vehicle};
        const view::Window window{trip.begin_s - margin_s, trip.end_s + margin_s};
        for (const auto& [key, title] : {std::pair{trip.baseline, trip.baseline_title},
                                         std::pair{trip.condition, trip.condition_title}}) {
            trace::RecordingReader recording(trace::recording_file(store_.folder(), key));
            play.runs.push_back(
                view::view_of(recording, network, window,
                              {.period_s = detail.period_s, .key_period_s = 10.0, .area = area}, title));
        }
        return play;
    }

    const roads::Network& network_of(const std::string& scenario) {
        const auto [at, is_new] = networks_.try_emplace(scenario);
        if (is_new) {
            const std::filesystem::path folder = store_.scenario_folder(scenario);
            at->second = roads::Network::read(
                folder / "network" / "network.net.xml",
                scenario::additional_files(scenario::load((folder / "scenario.toml").string())));
        }
        return *at->second;
    }

    const results::Store& store_;
    std::map<std::string, std::optional<roads::Network>> networks_;
};

std::string markup_of(const results::Store& store, const std::vector<Trip>& trips) {
    Plays plays(store);
    std::string markup;
    for (const Detail& detail : details) {
        markup = view::player_markup(plays.list(trips, detail));
        if (markup.size() <= most_bytes) return markup;
    }
    throw core::Error(core::ExitCode::fell_short,
                      fmt::format("the replays of the report need at least {} bytes, and {} are allowed; "
                                  "write a page for each with clearway replay --view",
                                  markup.size(), most_bytes));
}

}  // namespace

void require_replayable(const results::Store& store, const results::Results& results,
                        const report::StudyFacts& study, const ReplayRequest& request) {
    if (request.make == MakeReplays::no) return;
    const std::vector<Trip> trips = trips_to_show(results, study, "");
    std::vector<experiment::ConditionSpec> conditions = store.manifest().conditions;
    std::erase_if(conditions, [&](const experiment::ConditionSpec& condition) {
        return std::ranges::none_of(trips, [&](const Trip& trip) {
            return trip.condition.condition == condition.name || trip.baseline.condition == condition.name;
        });
    });
    require_trust(conditions, report::titles_of(store), store.folder().string(), request.trust);
}

ReportReplays replays_of(const results::Store& store, const results::Results& results,
                         const report::StudyFacts& study, const ReplayRequest& request) {
    const std::filesystem::path file = replays_file(store);
    const std::string stored = std::filesystem::exists(file) ? core::read_file(file) : "";
    const auto fits = [&](const std::vector<Trip>& trips) {
        return !trips.empty() && stored.starts_with(mark_of(trips));
    };
    const std::vector<Trip> trips = trips_to_show(results, study, "");
    if (fits(trips)) return {stored.substr(mark_of(trips).size()), view::script_source()};
    if (request.make == MakeReplays::no) {
        // They may be of a condition that the user chose.
        for (const experiment::ConditionSpec& condition : store.manifest().conditions) {
            const std::vector<Trip> others = trips_to_show(results, study, condition.name);
            if (fits(others)) return {stored.substr(mark_of(others).size()), view::script_source()};
        }
        if (!stored.empty())
            fmt::print(stderr,
                       "clearway: {}: no longer matches the results and is left out; clearway report {} "
                       "--replays makes it again\n",
                       file.string(), store.folder().string());
        return {};
    }
    if (trips.empty()) return {};
    MissingRecordings missing(store, trips);
    missing.make();
    std::string markup = markup_of(store, trips);
    core::write_atomically(file, mark_of(trips) + markup);
    return {std::move(markup), view::script_source()};
}

}  // namespace clearway::campaign
