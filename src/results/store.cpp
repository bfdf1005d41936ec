#include "results/store.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <fstream>
#include <set>
#include <system_error>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/near_file.hpp"
#include "core/number.hpp"
#include "core/own_output.hpp"
#include "core/part_folder.hpp"
#include "core/read_failure.hpp"
#include "experiment/condition_json.hpp"
#include "results/detail/record_files.hpp"
#include "results/detail/signal_event_files.hpp"
#include "results/detail/traffic_files.hpp"
#include "trace/recording.hpp"

namespace clearway::results {
namespace {

namespace fs = std::filesystem;

constexpr const char* manifest_name = "manifest.json";
constexpr const char* signal_events_name = "signal_events.csv";

/// Writes without flushing: for data that may be lost in a power failure.
void write_unflushed(const fs::path& file, const std::string& content) {
    std::ofstream stream(file, std::ios::binary);
    stream << content;
    if (!stream.flush()) throw core::write_error(file, errno);
}

/// Whether a power failure took the content of a file that was not flushed: file systems leave it empty, or
/// with zero bytes up to its length.
bool is_lost(const std::string& content) {
    return content.find_first_not_of('\0') == std::string::npos;
}

void require_same(const fs::path& file, const std::string& content, const experiment::RunKey& key) {
    if (core::read_file(file) == content) return;
    throw core::ConflictError(
        fmt::format("{}: run {} is stored with another content. Equal inputs must give equal bytes; "
                    "keep both folders and compare versions and machines",
                    file.string(), to_text(key)));
}

constexpr const char* cure_of_foreign = "Repeat the command that made the study (command.txt)";

/// Throws core::InputError when a file holds another run than its place says.
void require_key(const experiment::RunKey& held, const experiment::RunKey& key, const fs::path& file) {
    if (held == key) return;
    throw core::InputError({file.string(), "is of run " + to_text(held), to_text(key), cure_of_foreign});
}

/// Throws core::InputError for a record that was made in another study than its folder's.
void require_planned(const RunRecord& record, const Manifest& manifest, const std::string& file) {
    std::vector<core::Problem> problems;
    const auto require = [&](const char* key, const std::string& held, const std::string& planned) {
        if (held != planned)
            problems.push_back({file + ": " + key, fmt::format("is \"{}\", of another study", held),
                                fmt::format("\"{}\" as in manifest.json", planned), cure_of_foreign});
    };
    const experiment::Provenance planned = planned_provenance(manifest, record.key.scenario);
    require("build", record.build, manifest.clearway_build);
    require("clearway_version", record.provenance.clearway_version, planned.clearway_version);
    require("sumo_version", record.provenance.sumo_version, planned.sumo_version);
    require("configuration_hash", record.provenance.configuration_hash, planned.configuration_hash);
    require("study_seed", std::to_string(record.provenance.study_seed), std::to_string(planned.study_seed));
    const auto condition =
        std::ranges::find(manifest.conditions, record.key.condition, &experiment::ConditionSpec::name);
    if (condition != manifest.conditions.end() && record.condition != *condition)
        problems.push_back({file + ": condition_spec",
                            fmt::format("differs in {}: it is of another study",
                                        experiment::what_differs(*condition, record.condition)),
                            "the condition as in manifest.json", cure_of_foreign});
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

/// The wanted study without the replications and conditions by which it may extend the stored one.
Manifest without_growth(Manifest wanted, const Manifest& stored) {
    Manifest grown = stored;
    grown.conditions = wanted.conditions;
    if (continues(grown, stored)) wanted.conditions = stored.conditions;
    wanted.replications = std::min(wanted.replications, stored.replications);
    return wanted;
}

/// Throws core::InputError, naming what differs, if a folder's study cannot be extended to the wanted one.
void require_continues(const Manifest& wanted, const Manifest& stored, const fs::path& folder,
                       const core::Settings& titles) {
    if (continues(wanted, stored)) return;
    const std::string differing = differences(stored, without_growth(wanted, stored), titles);
    if (differing == "replications")
        throw core::InputError(
            {folder.string(),
             fmt::format("holds {} replications of this study, and {} are asked for", stored.replications,
                         wanted.replications),
             fmt::format("{} or more", stored.replications),
             "Ask for as many to continue or for more to extend it, or choose another folder with --out; "
             "`clearway report` prints what is there"});
    Manifest of_this_build = wanted;
    of_this_build.clearway_build = stored.clearway_build;
    if (continues(of_this_build, stored))
        throw core::InputError({folder.string(),
                                fmt::format("was made by another build of Clearway: {}, and this is {}",
                                            stored.clearway_build, wanted.clearway_build),
                                "runs of one build in a folder",
                                "Choose another folder with --out, and see with `clearway compare` whether "
                                "the builds differ; or "
                                "continue with the build that made it"});
    throw core::InputError(
        {folder.string(), "holds another study: different " + differing, "",
         "Choose another folder with --out, or ask for the same study to resume it. A study "
         "file can take over what is the same: `clearway study FILE --out NEW --reuse " +
             folder.string() + "`"});
}

/// `It holds run folders: runs/equip-city/fresh-4f2a11 and 3 more`; empty where it holds none.
std::string run_folders_in(const fs::path& folder) {
    std::vector<std::string> found;
    std::error_code unreadable;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, unreadable)) {
        std::error_code unknown;
        if (fs::exists(entry.path() / manifest_name, unknown)) found.push_back(entry.path().string());
    }
    if (found.empty()) return "";
    const std::string first = *std::ranges::min_element(found);
    return found.size() == 1 ? fmt::format("It holds a run folder: {}", first)
                             : fmt::format("It holds run folders: {} and {} more", first, found.size() - 1);
}

/// What to do with a folder that holds no runs itself.
std::string cure_of_another(const fs::path& folder) {
    if (folder.extension() == ".toml")
        return fmt::format("clearway study {} runs a study file", folder.string());
    std::error_code unknown;
    if (!fs::exists(folder, unknown)) return core::did_you_mean_file(folder);
    const std::string runs = run_folders_in(folder);
    if (!fs::exists(folder / "equip.json", unknown)) return runs;
    return fmt::format("{} shows its answer{}{}", (folder / "report.html").string(), runs.empty() ? "" : ". ",
                       runs);
}

/// `target`, with `.2`, `.3`, ... appended if it exists already.
fs::path free_place(const fs::path& target) {
    fs::path place = target;
    for (int number = 2; fs::exists(place); ++number)
        place = target.string() + fmt::format(".{}", number);
    return place;
}

void move_to(const fs::path& target, const fs::path& source) {
    std::error_code error;
    fs::rename(source, target, error);
    if (error)
        throw core::EnvironmentError(fmt::format("{}: is damaged and cannot be moved to {}: {}",
                                                 source.string(), target.string(), error.message()));
}

}  // namespace

Store::Store(const fs::path& folder, Manifest manifest)
    : folder_(folder.has_filename() ? folder : folder.parent_path()), manifest_(std::move(manifest)) {}

void Store::require_fits(const fs::path& folder, const Manifest& manifest, const core::Settings& titles) {
    if (fs::exists(folder / manifest_name))
        require_continues(manifest, open(folder).manifest(), folder, titles);
    else
        refuse_others(folder);
}

Store Store::create(const fs::path& folder, const Manifest& manifest) {
    core::make_folder(folder);
    require_fits(folder, manifest);
    const fs::path file = folder / manifest_name;
    if (fs::exists(file)) {
        const Store store = open(folder);
        if (to_json(manifest) == to_json(store.manifest())) return store;
        core::write_atomically(file, to_json(manifest));
        return {folder, manifest};
    }
    core::write_output(file, to_json(manifest));
    Store store(folder, manifest);
    core::flush_folder(fs::absolute(store.folder()).lexically_normal().parent_path());
    return store;
}

void Store::refuse_others(const fs::path& folder) {
    core::require_own(folder, {"clearway run", {manifest_name}});
}

Store Store::open(const fs::path& folder) {
    const fs::path file = folder / manifest_name;
    if (!fs::exists(file))
        throw core::InputError({folder.string(), "is not a run folder: it has no manifest.json",
                                "a folder written with --out", cure_of_another(folder)});
    return {folder, manifest_from_json(core::read_file(file), file.string())};
}

fs::path Store::scenario_folder(const std::string& scenario) const {
    return folder_ / "scenarios" / scenario;
}

fs::path Store::run_folder(const experiment::RunKey& key) const {
    return folder_ / "runs" / key.scenario / key.condition / fmt::format("{:05}", key.replication);
}

fs::path Store::error_file(const experiment::RunKey& key) const {
    return folder_ / "errors" / key.scenario / key.condition / fmt::format("{:05}.json", key.replication);
}

fs::path Store::unit_file(const std::string& unit) const {
    return folder_ / "units" / (unit + ".json");
}

fs::path Store::log_file(const std::string& unit) const {
    return folder_ / "logs" / (unit + ".log");
}

Store::Written Store::write(const RunRecord& record, const RunTiming& timing) const {
    const fs::path target = run_folder(record.key);
    const std::string vehicles = detail::vehicles_to_csv(record.vehicles);
    const std::string run = detail::run_to_json(record, vehicles, manifest_.clearway_build);
    core::make_folder(target.parent_path());
    core::PartFolder part(target);
    core::write_atomically(part.path() / "vehicles.csv", vehicles);
    if (record.signal_events)
        core::write_atomically(part.path() / signal_events_name,
                               detail::signal_events_to_csv(*record.signal_events));
    RunTiming dated = timing;
    dated.made_at = fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)));
    write_unflushed(part.path() / "timing.json", detail::timing_to_json(dated));
    core::write_atomically(part.path() / "run.json", run);
    const bool first = part.put_in_place();
    if (!first) {
        require_same(target / "run.json", run, record.key);
        require_same(target / "vehicles.csv", vehicles, record.key);
    }
    forget_error(record.key);
    return first ? Written::first : Written::already_there;
}

Store::Written Store::adopt(const Store& other, const experiment::RunKey& key) const {
    return adopt(other, key, key.condition);
}

Store::Written Store::adopt(const Store& other, const experiment::RunKey& key,
                            const std::string& condition_there) const {
    const experiment::RunKey there{key.scenario, condition_there, key.replication};
    other.check_record(there);
    const fs::path source = other.run_folder(there);
    const fs::path target = run_folder(key);
    bool first = false;
    if (!complete(key)) {
        core::PartFolder part(target);
        for (const auto& entry : fs::directory_iterator(source))
            core::copy_file(entry.path(), part.path() / entry.path().filename(), core::Copying::links);
        if (there != key) {
            const auto condition =
                std::ranges::find(manifest_.conditions, key.condition, &experiment::ConditionSpec::name);
            core::write_atomically(part.path() / "run.json",
                                   detail::run_named(core::read_file(source / "run.json"), key, *condition));
        }
        first = part.put_in_place();
    }
    for (const char* const name : {"run.json", "vehicles.csv"}) {
        if (first || there != key || core::read_file(source / name) == core::read_file(target / name))
            continue;
        throw core::ConflictError(
            fmt::format("run {} differs between {} and {} ({}). Equal inputs must give equal bytes; keep "
                        "both folders and compare versions and machines",
                        to_text(key), source.string(), target.string(), name));
    }
    forget_error(key);
    return first ? Written::first : Written::already_there;
}

void Store::adopt_recording(const Store& other, const experiment::RunKey& key) const {
    const fs::path recording = trace::recording_file(other.folder_, key);
    const fs::path place = trace::recording_file(folder_, key);
    if (!fs::exists(recording)) return;
    trace::check_recording(recording);
    if (has_recording(key)) return;
    core::make_folder(place.parent_path());
    core::copy_file(recording, place, core::Copying::links);
    core::flush_folder(place.parent_path());
}

bool Store::has_recording(const experiment::RunKey& key) const {
    return fs::exists(trace::recording_file(folder_, key));
}

std::vector<experiment::RunKey> Store::complete_runs() const {
    std::vector<experiment::RunKey> keys;
    for_each_file(folder_ / "runs", [&](const experiment::RunKey& key) {
        if (complete(key)) keys.push_back(key);
    });
    return keys;
}

std::vector<experiment::RunKey> Store::failed_runs() const {
    std::vector<experiment::RunKey> keys;
    for_each_file(folder_ / "errors", [&](const experiment::RunKey& key) {
        if (!complete(key)) keys.push_back(key);
    });
    return keys;
}

void Store::for_each_file(const fs::path& root,
                          const std::function<void(const experiment::RunKey&)>& visit) const {
    for (const ScenarioEntry& scenario : manifest_.scenarios) {
        for (const experiment::ConditionSpec& condition : manifest_.conditions) {
            std::error_code none;
            const fs::path folder = root / scenario.name / condition.name;
            for (auto entry = fs::directory_iterator(folder, none);
                 !none && entry != fs::directory_iterator(); entry.increment(none)) {
                const auto number = core::number_from<std::uint32_t>(entry->path().stem().string());
                if (number && *number < manifest_.replications)
                    visit({scenario.name, condition.name, *number});
            }
            if (none && none != std::errc::no_such_file_or_directory)
                core::fail_to_read(folder, none.value());
        }
    }
}

void Store::flush(const std::vector<experiment::RunKey>& keys) const {
    std::set<fs::path> folders;
    for (const experiment::RunKey& key : keys) {
        if (!complete(key)) continue;
        core::flush_folder(run_folder(key));
        for (const fs::path& entry : {run_folder(key), trace::recording_file(folder_, key)}) {
            fs::path folder = folder_;
            for (const fs::path& part : entry.lexically_relative(folder_).parent_path())
                folders.insert(folder /= part);
        }
    }
    for (const fs::path& folder : folders)
        if (fs::exists(folder)) core::flush_folder(folder);
    core::flush_folder(folder_);
}

void Store::write(const RunError& error) const {
    if (complete(error.key)) return;
    const fs::path file = error_file(error.key);
    core::make_folder(file.parent_path());
    core::write_atomically(file, detail::error_to_json(error));
}

bool Store::complete(const experiment::RunKey& key) const {
    return fs::exists(run_folder(key) / "run.json");
}

bool Store::done(const experiment::RunJob& unit, const experiment::ConditionSpec& condition) const {
    const experiment::RunKey key{unit.scenario, condition.name, unit.replication};
    if (!complete(key)) return false;
    return unit.recording == experiment::StepRecording::off ||
           condition.traffic_model == experiment::TrafficModel::free_flow || has_recording(key);
}

RunRecord Store::read_checked(const experiment::RunKey& key, std::string& vehicles) const {
    const fs::path folder = run_folder(key);
    const std::string file = (folder / "run.json").string();
    vehicles = core::read_file(folder / "vehicles.csv");
    RunRecord record = detail::run_from_json(core::read_file(file), vehicles, file);
    require_key(record.key, key, file);
    require_planned(record, manifest_, file);
    return record;
}

std::optional<RunRecord> Store::read(const experiment::RunKey& key, VehicleRows rows) const {
    if (!complete(key)) return std::nullopt;
    try {
        std::string vehicles;
        RunRecord record = read_checked(key, vehicles);
        record.vehicles =
            detail::vehicles_from_csv(vehicles, (run_folder(key) / "vehicles.csv").string(), rows);
        return record;
    } catch (const core::InputError& error) {
        std::vector<core::Problem> problems = error.problems();
        problems.back().cure =
            "This record is damaged or not of this study. Repeat the command that made the study "
            "(command.txt): it sets the record aside and makes the run again";
        throw core::InputError(std::move(problems));
    }
}

void Store::check_recording(const experiment::RunKey& key) const {
    const fs::path file = trace::recording_file(folder_, key);
    if (fs::exists(file)) trace::check_recording(file);
}

void Store::check(const experiment::RunKey& key) const {
    check_record(key);
    check_recording(key);
}

void Store::check_record(const experiment::RunKey& key) const {
    std::string vehicles;
    const fs::path folder = run_folder(key);
    if (fs::exists(folder)) {
        read_checked(key, vehicles);
        read_signal_events(key);
        read_timing(key);
    }
    read_error(key);
}

fs::path Store::make_place(const experiment::RunKey& key) const {
    const fs::path place = free_place(folder_ / "damaged" / key.scenario / key.condition /
                                      fmt::format("{:05}", key.replication));
    core::make_folder(place);
    return place;
}

std::vector<SetAside> Store::set_damaged_aside(const std::vector<experiment::RunKey>& keys) const {
    std::vector<SetAside> moved;
    for (const experiment::RunKey& key : keys) {
        try {
            check_record(key);
        } catch (const core::InputError& error) {
            const fs::path place = make_place(key);
            if (fs::exists(run_folder(key))) move_to(place / "run", run_folder(key));
            if (fs::exists(error_file(key))) move_to(place / "error.json", error_file(key));
            moved.push_back({key, place, error.what()});
        }
    }
    return moved;
}

std::vector<SetAside> Store::set_damaged_recordings_aside(const std::vector<experiment::RunKey>& keys) const {
    std::vector<SetAside> moved;
    for (const experiment::RunKey& key : keys) {
        try {
            check_recording(key);
        } catch (const core::InputError& error) {
            const fs::path place = make_place(key);
            move_to(place / "recording.h5", trace::recording_file(folder_, key));
            moved.push_back({key, place, error.what(), true});
        }
    }
    return moved;
}

metrics::TrafficTables Store::read_traffic(const experiment::RunKey& key) const {
    if (!complete(key)) return {};
    const std::string file = (run_folder(key) / "run.json").string();
    return detail::all_traffic_from_json(core::parse_object(core::read_file(file), file), file);
}

std::optional<std::vector<metrics::SignalEvent>> Store::read_signal_events(
    const experiment::RunKey& key) const {
    if (!complete(key)) return std::nullopt;
    const std::string record = (run_folder(key) / "run.json").string();
    const core::Json run = core::parse_object(core::read_file(record), record);
    if (!run.contains(detail::signal_events_hash_key)) return std::nullopt;
    const std::string file = (run_folder(key) / signal_events_name).string();
    const std::string text = core::read_file(file);
    std::vector<metrics::SignalEvent> events = detail::signal_events_from_csv(text, file);
    if (run[detail::signal_events_hash_key] != core::content_hash(text))
        throw core::InputError({file, "does not fit its hash in run.json", "",
                                "Repeat the command that made the study (command.txt): it sets the run "
                                "aside and makes it again"});
    return events;
}

std::optional<RunTiming> Store::read_timing(const experiment::RunKey& key) const {
    const fs::path file = run_folder(key) / "timing.json";
    if (!fs::exists(file)) return std::nullopt;
    const std::string text = core::read_file(file);
    if (is_lost(text)) return std::nullopt;
    return detail::timing_from_json(text, file.string());
}

std::optional<RunError> Store::read_error(const experiment::RunKey& key) const {
    const fs::path file = error_file(key);
    if (!fs::exists(file)) return std::nullopt;
    RunError error = detail::error_from_json(core::read_file(file), file.string());
    require_key(error.key, key, file);
    return error;
}

void Store::forget_error(const experiment::RunKey& key) const {
    std::error_code ignored;
    fs::remove(error_file(key), ignored);
}

void Store::remove_leftovers() const {
    std::error_code error;
    std::vector<fs::path> leftovers;
    for (auto entry = fs::recursive_directory_iterator(folder_, error);
         !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
        if (core::is_abandoned(entry->path())) leftovers.push_back(entry->path());
    }
    for (const fs::path& leftover : leftovers)
        fs::remove_all(leftover, error);
    fs::remove(folder_ / "work", error);  // Removed only if it is empty.
}

}  // namespace clearway::results
