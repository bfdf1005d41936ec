#include "campaign/run_plan.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <set>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "analysis/headline.hpp"
#include "analysis/summary.hpp"
#include "campaign/detail/abort_cure.hpp"
#include "campaign/names.hpp"
#include "campaign/programs.hpp"
#include "core/files.hpp"
#include "core/progress.hpp"
#include "core/shipped_files.hpp"
#include "python/nursery.hpp"
#include "python/part_name.hpp"
#include "report/console.hpp"
#include "report/html.hpp"
#include "report/read_facts.hpp"
#include "results/run_name.hpp"
#include "results/table_reader.hpp"
#include "results/table_writer.hpp"
#include "study/fresh_seeds.hpp"
#include "study/side_files.hpp"

namespace clearway::campaign {
namespace {

/// Failed runs that are named one by one; more are in runs.csv.
constexpr std::size_t named_errors = 10;

/// Replications that a run folder holds; 0 where there is none yet.
std::uint32_t replications_in(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / "manifest.json")) return 0;
    return results::Store::open(folder).manifest().replications;
}

bool is_in_python(const experiment::ConditionSpec& condition) {
    const auto is_part = [](const std::string& name) { return python::part_name_from(name).has_value(); };
    return is_part(condition.predictor) || std::ranges::any_of(condition.policies, is_part);
}

/// Where many runs have parts in Python, one interpreter is loaded for all of them.
std::unique_ptr<python::Nursery> nursery_for(const study::Plan& plan) {
    return std::ranges::any_of(plan.manifest.conditions, is_in_python) ? std::make_unique<python::Nursery>()
                                                                       : nullptr;
}

/// The headline of a study while it runs, read again every two seconds.
class PresentEstimate {
  public:
    explicit PresentEstimate(const results::Store& store) : headline_(store) {}

    const std::string& text() {
        const auto now = std::chrono::steady_clock::now();
        if (now - read_ < std::chrono::seconds(2)) return text_;
        headline_.refresh();
        text_ = headline_.text();
        read_ = now;
        return text_;
    }

  private:
    analysis::Headline headline_;
    std::string text_;
    std::chrono::steady_clock::time_point read_{};
};

/// Hidden files do not count: a shard's number and the lock.
bool is_absent_or_empty(const std::filesystem::path& folder) {
    std::error_code none;
    for (auto entry = std::filesystem::directory_iterator(folder, none);
         !none && entry != std::filesystem::directory_iterator(); entry.increment(none)) {
        if (!entry->path().filename().string().starts_with('.')) return false;
    }
    return true;
}

void say_how_to_continue(const std::filesystem::path& folder, const study::StudyProgress& progress,
                         const std::string& command) {
    fmt::print(stderr,
               "clearway: interrupted with {} of {} runs complete; they are kept in {}. To continue:\n  {}\n",
               progress.done, progress.total, folder.string(), command);
}

void write_report(const report::StudyFacts& facts, const ReportReplays& replays,
                  const std::filesystem::path& file) {
    std::ostringstream page;
    report::write_html(facts, page, {replays.markup, replays.script_source});
    core::write_atomically(file, page.str());
}

/// `: the last line of a log`, or nothing.
std::string last_words(std::string log) {
    while (log.ends_with('\n')) {
        log.pop_back();
    }
    const std::size_t line = log.rfind('\n');
    if (line != std::string::npos) log.erase(0, line + 1);
    return log.empty() ? "" : ": " + log;
}

void name_errors(const results::Store& store, const results::Results& results) {
    const std::size_t count = results.errors.size();
    if (count == 0) return;
    fmt::print(stderr, "clearway: {} of {} runs failed; their logs are in {}\n", count,
               results.manifest.runs().size(), (store.folder() / "logs").string());
    std::set<std::string> cures;
    for (std::size_t i = 0; i < std::min(count, named_errors); ++i) {
        const results::RunError& error = results.errors[i];
        fmt::print(stderr, "  {}: {}{}\n", results::run_name(store.folder(), error.key), error.message,
                   last_words(error.log_tail));
        if (const std::string cure = cure_of_abort(error); !cure.empty()) cures.insert(cure);
    }
    for (const std::string& cure : cures)
        fmt::print(stderr, "  {}\n", cure);
    if (count > named_errors) {
        fmt::print(stderr, "  and {} more, in {}\n", count - named_errors, store.runs_csv().string());
    }
}

}  // namespace

void check_seed(const study::StudyConfig& config, const std::filesystem::path& file,
                const std::filesystem::path& folder) {
    for (const core::Problem& problem : study::check_fresh_seed(config, file, folder))
        fmt::print(stderr, "clearway: warning: it is unknown whether seed {} was run here: {}\n", config.seed,
                   core::format_problem(problem));
}

study::Plan plan_for(const study::StudyConfig& config, RunPlanOptions& options) {
    check_names(config.conditions);
    const study::Versions versions = installed_versions();
    if (options.folder.empty()) {
        const results::Manifest manifest = study::make_plan(config, versions, "runs").manifest;
        options.folder = std::filesystem::path("runs") /
                         fmt::format("{}-{}", config.name, results::manifest_hash(manifest).substr(0, 6));
    }
    study::Plan plan = study::make_plan(config, versions, options.folder);
    for (study::PlannedUnit& planned : plan.units) {
        planned.unit.recording = options.recording;
    }
    return plan;
}

results::Store prepare_run_folder(const study::Plan& plan, const RunPlanOptions& options) {
    const bool is_new = is_absent_or_empty(options.folder);
    const std::uint32_t before = replications_in(options.folder);
    try {
        results::Store store = study::prepare_folder(plan, options.folder);
        study::complete_scenarios(plan, store);
        study::keep_command(store, options.command, before);
        if (before != 0 && !plan.manifest.precision && before != store.manifest().replications)
            fmt::print(stderr, "clearway: {}: extended from {} to {} replications\n", options.folder.string(),
                       before, store.manifest().replications);
        if (const auto trainings = core::shipped(std::filesystem::path("models") / "training"))
            study::copy_trainings(*trainings, store);
        return store;
    } catch (const core::InputError&) {
        std::error_code ignored;
        if (is_new) std::filesystem::remove_all(options.folder, ignored);
        throw;
    }
}

study::StudyResult run_missing(const study::Plan& plan, const results::Store& store,
                               const RunPlanOptions& options) {
    fmt::print(stderr, "clearway: {} runs into {}\n", plan.run_count(), options.folder.string());
    core::Progress progress("runs", plan.run_count(), core::Progress::style_for_stderr());
    PresentEstimate estimate(store);
    study::RunnerOptions runner;
    runner.workers = options.workers;
    runner.limits = options.limits;
    runner.on_set_aside = [&store](const results::SetAside& damaged) {
        fmt::print(stderr,
                   "clearway: {}: the record is damaged: {}. It is kept in {}, and the run is made again\n",
                   results::run_name(store.folder(), damaged.key), damaged.why, damaged.place.string());
    };
    const std::unique_ptr<python::Nursery> nursery = nursery_for(plan);
    study::StudyResult result = study::run(plan, store, runner, [&](const study::StudyProgress& now) {
        progress.begin_at(now.resumed);
        progress.update(now.done + now.failed, now.failed, estimate.text());
    });
    progress.finish();
    if (result.progress.done > result.progress.resumed) results::outdate_tables(store);
    if (was_interrupted(result)) say_how_to_continue(store.folder(), result.progress, options.command);
    return result;
}

bool was_interrupted(const study::StudyResult& result) {
    return result.exit_code == core::ExitCode::interrupted || result.exit_code == core::ExitCode::terminated;
}

core::ExitCode run_and_print(const study::Plan& plan, const RunPlanOptions& options) {
    const results::Store store = prepare_run_folder(plan, options);
    const study::StudyResult result = run_missing(plan, store, options);
    if (was_interrupted(result)) return result.exit_code;
    return publish(store, how_to_publish(options));
}

core::ExitCode publish(const results::Store& store, const PublishOptions& options) {
    if (!results::tables_are_current(store)) results::write_tables(store);
    const results::Results results = results::read_results(store, results::VehicleRows::emergency);
    const analysis::Summary summary =
        analysis::summarise(results, analysis::usual_level, options.response_threshold_s);
    const report::StudyFacts facts = report::facts_of(store, results, summary, options.least_relevant_s);
    write_report(facts, replays_of(store, results, options.replays), store.folder() / "report.html");
    fmt::print("{}", options.printing == Printing::json ? report::json_tables(facts)
                                                        : report::console_tables(facts, options.tables));
    name_errors(store, results);
    fmt::print(stderr, "clearway: written: {}\n", (store.folder() / "report.html").string());
    if (!results.missing.empty()) {
        fmt::print(stderr,
                   "clearway: {} of {} runs are missing; repeat the command that started them to "
                   "continue\n",
                   results.missing.size(), results.manifest.runs().size());
        return core::ExitCode::incomplete;
    }
    return results.errors.empty() ? core::ExitCode::ok : core::ExitCode::runs_failed;
}

}  // namespace clearway::campaign
