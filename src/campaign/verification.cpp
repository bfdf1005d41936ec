#include "campaign/verification.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "campaign/printout.hpp"
#include "campaign/programs.hpp"
#include "campaign/run_name.hpp"
#include "campaign/signal_audit.hpp"
#include "campaign/study_run.hpp"
#include "campaign/worker_jobs.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/temporary_folder.hpp"
#include "core/terminal.hpp"
#include "report/read_facts.hpp"
#include "results/record_difference.hpp"
#include "study/plan.hpp"
#include "trace/difference.hpp"
#include "trace/recording.hpp"

namespace clearway::campaign {
namespace {

/// Cells of a table that are shown when a run differs.
constexpr std::size_t shown_cells = 3;

enum class Verdict : std::uint8_t { same, different, damaged, failed };

struct Verification {
    std::string run;  ///< Its name.
    Verdict verdict = Verdict::same;
    std::string hash;  ///< Trace hash of the stored record; empty when it cannot be read.
    std::string cause;
    std::vector<results::CellDifference> cells;
    std::string first_step;  ///< Where two recordings first differ; empty without recordings.
};

const char* text_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::same:
            return "same";
        case Verdict::different:
            return "different";
        case Verdict::damaged:
            return "damaged";
        case Verdict::failed:
            return "failed";
    }
    return "";
}

/// Another version may legitimately give other numbers, so a comparison would show nothing.
void require_same_versions(const results::Manifest& manifest) {
    const study::Versions here = installed_versions();
    std::string differing;
    if (manifest.sumo_version != here.sumo)
        differing += fmt::format("SUMO {} in the study, {} here", manifest.sumo_version, here.sumo);
    if (manifest.clearway_version != here.clearway)
        differing += fmt::format("{}Clearway {} in the study, {} here", differing.empty() ? "" : "; ",
                                 manifest.clearway_version, here.clearway);
    if (manifest.clearway_build != here.build)
        differing += fmt::format("{}build {} of Clearway in the study, {} here",
                                 differing.empty() ? "" : "; ", manifest.clearway_build, here.build);
    if (!differing.empty())
        throw core::EnvironmentError(
            fmt::format("this study was made with other versions ({}), so a run made here may differ. Verify "
                        "with the versions of the study",
                        differing));
}

/// Throws core::InputError for a scenario of these runs that lacks what they are made of, and, as a continued
/// study does, for one that was changed: its runs made now would be others.
void require_unchanged(const results::Store& store, const std::vector<experiment::RunKey>& keys) {
    for (const results::ScenarioEntry& entry : store.manifest().scenarios) {
        if (!core::contains(keys, entry.name, &experiment::RunKey::scenario)) continue;
        const std::filesystem::path folder = store.scenario_folder(entry.name);
        for (const char* const name : {"scenario.toml", "network/network.net.xml"})
            if (!std::filesystem::exists(folder / name))
                throw core::InputError({(folder / name).string(), "is missing", "",
                                        fmt::format("Put it back, or remove {} and repeat the command that "
                                                    "made the study (command.txt): it is made again",
                                                    folder.string())});
        study::require_unchanged(entry, folder);
    }
}

/// The runs to verify and the store that holds them.
struct Chosen {
    results::Store store;
    std::vector<experiment::RunKey> keys;
};

Chosen chosen_run(const std::string& name) {
    NamedRun run = run_named(name, "RUN");
    if (run.store.complete(run.key)) return {std::move(run.store), {run.key}};
    const auto failure = run.store.read_error(run.key);
    throw core::Error(
        core::ExitCode::incomplete,
        fmt::format("run {} {}; there is nothing to compare with", run_name(run.store.folder(), run.key),
                    failure ? "failed: " + failure->message : "has not been made yet"));
}

/// As equally many runs of each condition in each scenario as possible, of different replications; where they
/// are fewer than these, of conditions over the whole range. `count` is below the number of runs.
std::vector<experiment::RunKey> sample_of(const std::vector<experiment::RunKey>& runs, std::size_t count) {
    std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> cells;  // places of their runs
    for (std::size_t at = 0; at < runs.size(); ++at)
        cells[{runs[at].scenario, runs[at].condition}].push_back(at);
    std::vector<std::size_t> places;
    for (std::size_t round = 0; places.size() < count; ++round) {
        std::vector<std::size_t> offered;
        std::size_t turn = round;  // other replications of other cells
        for (const auto& [name, cell] : cells) {
            if (round < cell.size()) offered.push_back(cell[turn % cell.size()]);
            ++turn;
        }
        const std::size_t taken = std::min(count - places.size(), offered.size());
        for (std::size_t i = 0; i < taken; ++i)
            places.push_back(offered[i * offered.size() / taken]);
    }
    std::ranges::sort(places);
    std::vector<experiment::RunKey> sample;
    for (const std::size_t at : places)
        sample.push_back(runs[at]);
    return sample;
}

/// `Not sampled: Ours; corridor. --sample 17 takes a run of each condition.`, or empty.
std::string left_out_text(const results::Store& store, const std::vector<experiment::RunKey>& keys) {
    const core::Settings titles = report::titles_of(store);
    std::vector<std::string> left_out;
    std::set<std::pair<std::string, std::string>> cells;
    for (const experiment::RunKey& key : store.manifest().runs()) {
        cells.emplace(key.scenario, key.condition);
        const bool is_in = core::contains(keys, key.condition, &experiment::RunKey::condition);
        const std::string& title = titles.at(key.condition);
        if (!is_in && !core::contains(left_out, title)) left_out.push_back(title);
    }
    if (left_out.empty()) return "";
    return core::wrapped(fmt::format("Not sampled: {}. --sample {} takes a run of each condition.",
                                     fmt::join(left_out, "; "), cells.size()),
                         4) +
           "\n";
}

std::vector<experiment::RunKey> complete_runs(const results::Store& store, const VerifyRequest& request) {
    std::vector<experiment::RunKey> complete = store.manifest().runs();
    std::erase_if(complete, [&](const experiment::RunKey& key) { return !store.complete(key); });
    if (complete.empty())
        throw core::Error(
            core::ExitCode::incomplete,
            fmt::format("{}: no run is complete; there is nothing to compare with", store.folder().string()));
    if (request.sample == 0 || request.sample >= complete.size()) return complete;
    return sample_of(complete, request.sample);
}

Chosen chosen_runs(const VerifyRequest& request) {
    const bool is_folder = std::filesystem::exists(std::filesystem::path(request.what) / "manifest.json");
    const bool wants_many = request.all || request.sample > 0 || (request.signals && is_folder);
    if (is_folder && !wants_many)
        throw core::InputError({"RUN", fmt::format("{} is a whole run folder", request.what), run_name_form,
                                "Name one of its runs, or add --all or --sample N"});
    if (request.signals && !is_folder && !names_a_run(request.what))
        throw core::InputError(
            {"RUN|DIR", fmt::format("{} is not a run folder", request.what),
             fmt::format("a folder written with --out, or one run of it, {}", run_name_form),
             "It holds a manifest.json"});
    if (!wants_many) return chosen_run(request.what);
    if (!is_folder)
        throw core::InputError({"RUN", fmt::format("{} is not a run folder", request.what),
                                "a folder written with --out",
                                "For a single run leave out --all and --sample"});
    results::Store store = results::Store::open(request.what);
    std::vector<experiment::RunKey> keys = complete_runs(store, request);
    return {std::move(store), std::move(keys)};
}

/// A plan that repeats these runs from the scenarios and networks of the folder. `conditions`: those of the
/// runs, with the files of the user where they are now.
study::Plan plan_of(const results::Store& store, const std::vector<experiment::RunKey>& keys,
                    const std::vector<experiment::ConditionSpec>& conditions,
                    const std::filesystem::path& out) {
    study::Plan plan;
    plan.manifest = store.manifest();
    std::map<std::string, std::size_t> unit_of;
    for (const experiment::RunKey& key : keys) {
        experiment::RunJob job = stored_job(store, key, out);
        job.conditions = {*std::ranges::find(conditions, key.condition, &experiment::ConditionSpec::name)};
        if (std::filesystem::exists(trace::recording_file(store.folder(), key)))
            job.recording = experiment::StepRecording::on;
        const std::string name =
            fmt::format("{}-{:05}-{}", key.scenario, key.replication,
                        experiment::to_text(experiment::process_of(job.conditions.front())));
        const auto [unit, is_new] = unit_of.try_emplace(name, plan.units.size());
        if (is_new) {
            plan.units.push_back({name, std::move(job)});
            continue;
        }
        experiment::RunJob& together = plan.units[unit->second].unit;
        together.conditions.push_back(job.conditions.front());
        if (job.recording == experiment::StepRecording::on) together.recording = job.recording;
    }
    return plan;
}

/// The first difference between two recordings of a run; empty if there is none or a recording is missing.
std::string first_differing_step(const std::filesystem::path& one, const std::filesystem::path& other) {
    if (!std::filesystem::exists(one) || !std::filesystem::exists(other)) return "";
    try {
        trace::RecordingReader left(one);
        trace::RecordingReader right(other);
        while (true) {
            const auto before = left.next();
            const auto now = right.next();
            if (!before && !now) return "";
            if (!before || !now) return "one recording ends earlier";
            const double time_s = before->time().value;
            if (const auto found = trace::difference(*before->snapshot, *now->snapshot))
                return fmt::format("at {} s, snapshot: {}", time_s, *found);
            if (before->observation != nullptr && now->observation != nullptr)
                if (const auto found = trace::difference(*before->observation, *now->observation))
                    return fmt::format("at {} s, observation: {}", time_s, *found);
            if (before->belief != nullptr && now->belief != nullptr)
                if (const auto found = trace::difference(*before->belief, *now->belief))
                    return fmt::format("at {} s, belief: {}", time_s, *found);
            if (const auto found = trace::difference(before->leases, now->leases))
                return fmt::format("at {} s, {}", time_s, *found);
        }
    } catch (const core::InputError& error) {
        return error.what();
    }
}

Verification verify(const results::Store& stored, const results::Store& again,
                    const experiment::RunKey& key) {
    Verification verification;
    verification.run = run_name(stored.folder(), key);
    try {
        stored.check(key);
        if (const auto record = stored.read(key)) verification.hash = record->provenance.trace_hash;
        if (!again.complete(key)) {
            const auto failure = again.read_error(key);
            verification.verdict = Verdict::failed;
            verification.cause = failure ? failure->message : "was not made";
            return verification;
        }
        verification.cells = results::differences(stored, again, key);
    } catch (const core::InputError& error) {
        verification.verdict = Verdict::damaged;
        verification.cause = error.what();
        return verification;
    }
    if (verification.cells.empty()) return verification;
    verification.verdict = Verdict::different;
    verification.first_step = first_differing_step(trace::recording_file(stored.folder(), key),
                                                   trace::recording_file(again.folder(), key));
    return verification;
}

/// Names of the tables in which a run differs, in the order in which they were compared.
std::vector<std::string> tables_of(const std::vector<results::CellDifference>& cells) {
    std::vector<std::string> tables;
    for (const results::CellDifference& cell : cells)
        if (!core::contains(tables, cell.table)) tables.push_back(cell.table);
    return tables;
}

/// Why, and the first cells of each table that differ.
std::vector<std::string> lines_of(const Verification& each) {
    std::vector<std::string> lines;
    if (!each.cause.empty()) lines.push_back(each.cause);
    if (!each.first_step.empty()) lines.push_back("recordings first differ " + each.first_step);
    for (const std::string& table : tables_of(each.cells)) {
        std::size_t count = 0;
        for (const results::CellDifference& cell : each.cells) {
            if (cell.table != table || ++count > shown_cells) continue;
            lines.push_back(fmt::format("{}{}: {}: stored {}, now {}", table,
                                        cell.row.empty() ? "" : " row " + cell.row, cell.column, cell.one,
                                        cell.other));
        }
        if (count > results::most_differences)
            lines.push_back(fmt::format("{}: more than {} cells differ", table, results::most_differences));
        else if (count > shown_cells)
            lines.push_back(fmt::format("{}: {} cells differ in all", table, count));
    }
    return lines;
}

core::Json text_or_null(const std::string& text) {
    return text.empty() ? core::Json(nullptr) : core::Json(text);
}

core::Json json_of(const std::vector<results::CellDifference>& cells) {
    core::Json list = core::Json::array();
    for (const results::CellDifference& cell : cells)
        list.push_back({{"table", cell.table},
                        {"row", cell.row},
                        {"column", cell.column},
                        {"stored", cell.one},
                        {"now", cell.other}});
    return list;
}

/// The worst of all verdicts.
core::ExitCode code_of(const std::vector<Verification>& verifications) {
    const auto any = [&](Verdict verdict) {
        return core::contains(verifications, verdict, &Verification::verdict);
    };
    if (any(Verdict::different)) return core::ExitCode::conflict;
    if (any(Verdict::damaged)) return core::ExitCode::bad_input;
    return any(Verdict::failed) ? core::ExitCode::runs_failed : core::ExitCode::ok;
}

Printout printout_of(const std::vector<Verification>& verifications) {
    core::Json facts = {{"verified", verifications.size()}};
    std::string sum = fmt::format("{} verified", verifications.size());
    for (const Verdict verdict : {Verdict::same, Verdict::different, Verdict::damaged, Verdict::failed}) {
        const auto count = std::ranges::count(verifications, verdict, &Verification::verdict);
        facts[text_of(verdict)] = count;
        sum += fmt::format("{} {} {}", verdict == Verdict::same ? ":" : ",", count, text_of(verdict));
    }
    Table runs{"runs",
               {{"verdict", "verdict"},
                {"run", "run"},
                {"trace_hash", "trace"},
                {"cause", ""},
                {"first_differing_step", ""},
                {"differences", ""}},
               {}};
    for (const Verification& each : verifications)
        runs.rows.push_back({{text_of(each.verdict), each.run, text_or_null(each.hash),
                              text_or_null(each.cause), text_or_null(each.first_step), json_of(each.cells)},
                             lines_of(each)});
    return {facts, {runs}, verifications.size() > 1 ? sum + "\n" : ""};
}

void require_elsewhere(const results::Store& stored, const std::string& out) {
    std::error_code none;
    if (std::filesystem::equivalent(stored.folder(), out, none))
        throw core::InputError({"--out", fmt::format("{} is the folder to verify", out),
                                "a new or empty folder",
                                "The runs must be repeated elsewhere to be compared"});
}

/// Makes runs again in `out`. The exit code tells an interruption.
std::pair<results::Store, core::ExitCode> repeat(const results::Store& stored,
                                                 const std::vector<experiment::RunKey>& keys,
                                                 const std::vector<experiment::ConditionSpec>& conditions,
                                                 const std::filesystem::path& out, unsigned jobs) {
    const study::Plan plan = plan_of(stored, keys, conditions, out);
    results::Store again = results::Store::create(out, plan.manifest);
    core::Progress progress("runs", keys.size(), core::Progress::style_for_stderr());
    WorkersOptions options;
    options.workers = jobs;
    const StudyResult result = run_units(plan, again, options, [&](const StudyProgress& now) {
        progress.set_work(now.work);
        progress.update(now.done + now.failed, now.failed);
    });
    progress.finish();
    return {std::move(again), result.exit_code};
}

/// Those of the runs, with the files of the user where they are now.
std::vector<experiment::ConditionSpec> conditions_of(const results::Store& store,
                                                     const std::vector<experiment::RunKey>& keys) {
    std::vector<experiment::ConditionSpec> conditions = store.manifest().conditions;
    std::erase_if(conditions, [&](const experiment::ConditionSpec& condition) {
        return !core::contains(keys, condition.name, &experiment::RunKey::condition);
    });
    for (experiment::ConditionSpec& condition : conditions)
        condition = with_files_found(condition, store.folder());
    return conditions;
}

core::ExitCode audit(const VerifyRequest& request) {
    const auto [store, keys] = chosen_runs(request);
    const AuditReport report = audit_runs(store, keys);
    print(audit_printout(report), request.printing);
    if (nothing_audited(report))
        throw core::Error(core::ExitCode::incomplete, nothing_audited_text(report, request.what));
    return code_of(report);
}

}  // namespace

core::ExitCode verify_runs(const VerifyRequest& request) {
    if (request.signals) return audit(request);
    const auto [stored, keys] = chosen_runs(request);
    require_elsewhere(stored, request.out);
    const std::vector<experiment::ConditionSpec> conditions = conditions_of(stored, keys);
    require_trust(conditions, report::titles_of(stored), stored.folder().string(), request.trust);
    // Another version may read the same scenario in another way.
    require_same_versions(stored.manifest());
    require_unchanged(stored, keys);
    renew_edited_tables(stored);
    std::optional<core::TemporaryFolder> temporary;
    if (request.out.empty()) temporary.emplace();
    const auto [again, code] =
        repeat(stored, keys, conditions, temporary ? temporary->path() : std::filesystem::path(request.out),
               request.workers);
    if (is_interrupted(code)) return code;
    std::vector<Verification> verifications;
    for (const experiment::RunKey& key : keys)
        verifications.push_back(verify(stored, again, key));
    Printout printout = printout_of(verifications);
    if (request.sample > 0) printout.text += left_out_text(stored, keys);
    print(printout, request.printing);
    return code_of(verifications);
}

}  // namespace clearway::campaign
