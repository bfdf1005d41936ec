#include "campaign/study_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/headline.hpp"
#include "analysis/replications.hpp"
#include "analysis/summary.hpp"
#include "campaign/detail/failures.hpp"
#include "campaign/detail/run_cost.hpp"
#include "campaign/names.hpp"
#include "campaign/plan_text.hpp"
#include "campaign/printout.hpp"
#include "campaign/programs.hpp"
#include "campaign/run_name.hpp"
#include "campaign/stored_folder.hpp"
#include "core/counted.hpp"
#include "core/leftovers.hpp"
#include "core/progress.hpp"
#include "core/shipped_files.hpp"
#include "core/supervisor.hpp"
#include "experiment/code_parts.hpp"
#include "prediction/predictor.hpp"
#include "python/nursery.hpp"
#include "python/part_name.hpp"
#include "report/console.hpp"
#include "report/html.hpp"
#include "report/read_facts.hpp"
#include "results/table_reader.hpp"
#include "results/table_writer.hpp"
#include "study/fresh_seeds.hpp"
#include "study/reuse.hpp"
#include "study/side_files.hpp"

namespace clearway::campaign {
namespace {

/// What a study has more of than its folder had, `from 2 to 4 replications`; empty for the same study.
std::string growth_of(const results::Manifest& before, const results::Manifest& now) {
    std::vector<std::string> more;
    if (before.replications != now.replications)
        more.push_back(fmt::format("from {} to {}", before.replications,
                                   core::counted(now.replications, "replication")));
    if (before.conditions.size() != now.conditions.size())
        more.push_back(fmt::format("from {} to {}", before.conditions.size(),
                                   core::counted(now.conditions.size(), "condition")));
    return fmt::format("{}", fmt::join(more, ", "));
}

bool is_in_python(const experiment::ConditionSpec& condition) {
    const auto is_part = [](const std::string& name) { return python::part_name_from(name).has_value(); };
    return is_part(condition.predictor) || std::ranges::any_of(condition.policies, is_part);
}

/// Whether a condition repairs by a net, so that its training belongs to the study.
bool learns(const study::Plan& plan) {
    const std::vector<std::string> learned = prediction::predictors().names(traffic::Trait::learned);
    return std::ranges::any_of(plan.manifest.conditions, [&](const experiment::ConditionSpec& condition) {
        return core::contains(learned, condition.predictor);
    });
}

/// Where many runs have parts in Python, one interpreter is loaded for all of them.
std::unique_ptr<python::Nursery> nursery_for(const study::Plan& plan) {
    return std::ranges::any_of(plan.manifest.conditions, is_in_python) ? std::make_unique<python::Nursery>()
                                                                       : nullptr;
}

/// The headline of a study while it runs, read again every two seconds.
class PresentEstimate {
  public:
    explicit PresentEstimate(const results::Store& store) : headline_(store, report::titles_of(store)) {}

    /// `done`: runs that have ended; all of them are read at the end.
    const std::string& text(std::size_t done, std::size_t total) {
        const auto now = std::chrono::steady_clock::now();
        if (now - read_ < std::chrono::seconds(2) && done < total) return text_;
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

void say_how_to_continue(const study::Plan& plan, const std::filesystem::path& folder,
                         const StudyProgress& progress, const RunOptions& options) {
    fmt::print(stderr,
               "clearway: interrupted with {} of {} complete; they are kept in {}. To continue:\n  {}\n",
               progress.done, core::counted(progress.total, "run"), folder.string(), options.command);
    constexpr double telling_share = 0.02;  // as much as the line of progress told
    if (progress.work > telling_share) {
        fmt::print(stderr, "clearway: about {} is left\n",
                   core::clock_text(progress.elapsed_s * (1.0 - progress.work) / progress.work));
        return;
    }
    if (progress.done == 0) return;  // nothing to estimate by
    try {
        if (const auto left = estimated_time_left(plan, folder, options.workers))
            fmt::print(stderr, "clearway: about {} is left\n", core::clock_text(left->wall_s));
    } catch (const std::exception&) {  // a run folder beside it that cannot be read: no estimate
    }
}

void write_report(const report::StudyFacts& facts, const ReportReplays& replays,
                  const std::filesystem::path& file) {
    std::ostringstream page;
    report::write_html(facts, page, {replays.markup, replays.script_source});
    core::write_output(file, page.str());
}

enum class Outcome : std::uint8_t { reached, capped, unknown, more };

struct Round {
    Outcome outcome = Outcome::unknown;
    std::uint32_t next = 0;  ///< Replications of the next round, when there is one.
    std::string text;        ///< What was found, for the user.
};

/// Decides from the replications so far whether another round follows.
Round judge(const results::Store& store, const results::PrecisionTarget& target) {
    const results::Results results = results::read_results(store);
    const auto found = analysis::widest(analysis::summarise(results), target.metric, target.half_width);
    if (!found) return {Outcome::unknown, 0, "no interval: too few complete runs"};
    const std::uint32_t now = results.manifest.replications;
    const auto wanted =
        static_cast<std::uint32_t>(std::min<std::size_t>(found->required + found->lost, target.at_most));
    Round round;
    round.text = fmt::format("{} of {}/{} is known to +- {:.3g} after {}; wanted: +- {:g}", target.metric,
                             found->scenario, found->condition, found->half_width,
                             core::counted(now, "replication"), target.half_width);
    round.next = std::max(wanted, now);
    if (found->required <= found->n) {
        round.outcome = Outcome::reached;
    } else {
        round.outcome = now >= target.at_most ? Outcome::capped : Outcome::more;
        round.text += fmt::format(", for which {} are needed", found->required + found->lost);
    }
    return round;
}

void say(const Round& round) {
    const char* end = "";
    if (round.outcome == Outcome::reached) end = ": reached";
    if (round.outcome == Outcome::capped) end = ": stopped at the cap of the study file (at_most)";
    fmt::print(stderr, "clearway: {}{}\n", round.text, end);
}

void print_shard(const study::Shard& shard, const StudyProgress& progress, const std::string& folder,
                 Printing printing) {
    print({{{"shard", study::to_text(shard)},
            {"folder", folder},
            {"runs", progress.total},
            {"complete_runs", progress.done},
            {"failed_runs", progress.failed}},
           {},
           fmt::format("shard {}: {} of {} complete, {} failed, in {}\n", study::to_text(shard),
                       progress.done, core::counted(progress.total, "run"), progress.failed, folder)},
          printing);
}

/// Tells on standard error what was taken over, and of which conditions nothing was.
void take_over(const results::Store& store, const std::filesystem::path& from) {
    const study::Reused reused = study::reuse(store, from);
    for (const std::string& damaged : reused.damaged)
        fmt::print(stderr, "clearway: {}\n", damaged);
    fmt::print(
        stderr, "clearway: {} taken over from {}{}{}\n", core::counted(reused.runs, "run"), from.string(),
        reused.renamed.empty() ? "" : fmt::format(", also of {}", fmt::join(reused.renamed, ", ")),
        reused.other_conditions.empty()
            ? ""
            : fmt::format("; not those of {}, which differ", fmt::join(reused.other_conditions, ", ")));
}

/// Whether all runs of what is compared failed: the cause is the answer then.
bool is_all_lost(const report::StudyFacts& facts) {
    std::size_t lost = 0, kept = 0;
    for (const report::ScenarioFacts& scenario : facts.scenarios)
        for (const report::ConditionFacts& condition : scenario.conditions)
            if (condition.is_compared())
                ++(condition.complete_runs == 0 && !condition.failed.empty() ? lost : kept);
    return lost > 0 && kept == 0;
}

}  // namespace

void check_seed(const study::StudyConfig& config, const std::filesystem::path& file,
                const std::filesystem::path& folder) {
    for (const core::Problem& problem : study::check_fresh_seed(config, file, folder))
        fmt::print(stderr, "clearway: warning: it is unknown whether seed {} was run here: {}\n", config.seed,
                   core::format_problem(problem));
}

study::StudyConfig study_of(scenario::ScenarioConfig scenario,
                            std::vector<experiment::ConditionSpec> conditions, std::uint64_t seed,
                            std::uint32_t replications) {
    study::StudyConfig config;
    config.name = scenario.name;
    config.seed = seed;
    config.replications = replications;
    config.scenarios = {std::move(scenario)};
    config.conditions = std::move(conditions);
    return config;
}

study::Plan plan_for(const study::StudyConfig& config, RunOptions& options) {
    check_names(config.conditions);
    if (!config.doubtful_titles.empty()) throw core::InputError(config.doubtful_titles);
    const study::Versions versions = installed_versions();
    if (options.folder.empty()) {
        const results::Manifest manifest = study::make_plan(config, versions, "runs").manifest;
        options.folder = std::filesystem::path("runs") /
                         fmt::format("{}-{}", config.name, results::study_hash(manifest).substr(0, 6));
    }
    study::Plan plan = study::make_plan(config, versions, options.folder);
    for (study::PlannedUnit& planned : plan.units) {
        planned.unit.recording = options.recording;
    }
    return plan;
}

results::Store prepare_run_folder(const study::Plan& plan, const RunOptions& options) {
    // Removed below: nothing of the user's may be in it, hidden or not.
    const bool is_new = core::holds_only(
        options.folder, [](const std::string& name) { return name == ".shard" || name == ".lock"; });
    const std::optional<results::Manifest> before = study_in(options.folder);
    try {
        results::Store store = study::prepare_folder(plan, options.folder);
        study::complete_scenarios(plan, store);
        const std::string growth = before ? growth_of(*before, store.manifest()) : "";
        study::keep_command(store, options.command,
                            growth.empty() ? study::Growth::none : study::Growth::more);
        study::keep_titles(store, plan.titles);
        study::keep_controls(store, plan.controls);
        study::keep_study_file(store, plan.text);
        experiment::keep_code(plan.manifest.conditions, store.folder());
        if (!growth.empty() && !plan.manifest.precision)
            fmt::print(
                stderr,
                "clearway: {0}: extended {1}. It keeps what was added; a study with less takes its runs "
                "from here: --out NEW --reuse {0}\n",
                options.folder.string(), growth);
        if (!options.reused.empty()) take_over(store, options.reused);
        const auto trainings = core::shipped(std::filesystem::path("models") / "training");
        if (trainings && learns(plan)) study::copy_trainings(*trainings, store);
        return store;
    } catch (const core::InputError&) {
        std::error_code ignored;
        if (is_new) std::filesystem::remove_all(options.folder, ignored);
        throw;
    }
}

StudyResult run_part(const study::Plan& plan, const results::Store& store, const RunOptions& options,
                     const std::function<void(const StudyProgress&)>& on_progress) {
    WorkersOptions workers;
    workers.workers = options.workers;
    workers.limits = options.limits;
    workers.retried = options.retried;
    workers.on_set_aside = [&store](const results::SetAside& damaged) {
        fmt::print(stderr, "clearway: {}: the {} is damaged: {}. It is kept in {}, and the run is {}\n",
                   run_name(store.folder(), damaged.key), damaged.is_recording ? "recording" : "record",
                   damaged.why, damaged.place.string(),
                   damaged.is_recording ? "recorded again" : "made again");
    };
    const std::unique_ptr<python::Nursery> nursery = nursery_for(plan);
    StudyResult result = run_units(plan, store, workers, on_progress);
    if (result.progress.done > result.progress.resumed) results::outdate_tables(store);
    return result;
}

StudyResult run_missing(const study::Plan& plan, const results::Store& store, const RunOptions& options) {
    const bool few = plan.manifest.conditions.size() > 1 && !plan.manifest.precision &&
                     plan.manifest.replications < analysis::fewest_for_interval;
    fmt::print(
        stderr, "clearway: {} into {}{}{}\n", core::counted(plan.run_count(), "run"), options.folder.string(),
        options.stays_if_failed ? ", which stays if one fails" : "",
        few ? fmt::format("; fewer than {} seeds give no interval", analysis::fewest_for_interval) : "");
    const auto started = std::chrono::steady_clock::now();
    core::Progress progress("runs", plan.run_count(), core::Progress::style_for_stderr());
    PresentEstimate estimate(store);
    StudyResult result = run_part(plan, store, options, [&](const StudyProgress& now) {
        progress.begin_at(now.resumed);
        const std::size_t ended = now.done + now.failed;
        progress.set_work(now.work);
        progress.update(ended, now.failed, estimate.text(ended, now.total));
    });
    progress.finish();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
    const auto processes = std::min(core::process_count(options.workers), plan.units.size());
    // Of a study that was made in one go: the time of earlier calls is not known.
    if (result.exit_code == core::ExitCode::ok && result.progress.resumed == 0)
        note_pace(store, took.count() * static_cast<double>(processes));
    if (is_interrupted(result.exit_code)) say_how_to_continue(plan, store.folder(), result.progress, options);
    return result;
}

std::string interrupted_between_runs(const std::string& command) {
    return fmt::format(
        "clearway: interrupted while no run was under way; nothing is lost. To continue:\n  {}\n", command);
}

bool is_interrupted(core::ExitCode code) {
    return code == core::ExitCode::interrupted || code == core::ExitCode::terminated;
}

std::uint32_t replications_so_far(const study::StudyConfig& config, const std::filesystem::path& folder) {
    const auto stored = config.precision ? study_in(folder) : std::nullopt;
    return stored && stored->precision == config.precision
               ? std::max(config.replications, stored->replications)
               : config.replications;
}

void require_divisible(const study::StudyConfig& config, const study::Shard& shard) {
    if (config.precision && !shard.whole())
        throw core::InputError({"--shard",
                                "the study has a precision target, which needs all its runs at once",
                                "a study with replications",
                                "Run it as a whole, or give the number of replications that it reached"});
}

core::ExitCode run_shard(const study::StudyConfig& config, const study::Shard& shard, RunOptions options) {
    require_divisible(config, shard);
    study::Plan plan = plan_for(config, options);
    study::keep_shard(plan, shard);
    study::claim(options.folder, shard);
    const results::Store store = prepare_run_folder(plan, options);
    const StudyResult result = run_missing(plan, store, options);
    if (!is_interrupted(result.exit_code))
        print_shard(shard, result.progress, options.folder.string(), options.publish.printing);
    return result.exit_code;
}

core::ExitCode complete(const study::Plan& plan, const results::Store& store, const RunOptions& options) {
    const StudyResult result = run_missing(plan, store, options);
    return is_interrupted(result.exit_code) ? result.exit_code : publish(store, options.publish);
}

core::ExitCode run_study(study::StudyConfig config, RunOptions options) {
    config.replications = replications_so_far(config, options.folder);
    while (true) {
        const study::Plan plan = plan_for(config, options);
        const results::Store store = prepare_run_folder(plan, options);
        if (!config.precision) return complete(plan, store, options);
        const StudyResult result = run_missing(plan, store, options);
        if (is_interrupted(result.exit_code)) return result.exit_code;
        const Round round = judge(store, *config.precision);
        say(round);
        if (round.outcome != Outcome::more) return publish(store, options.publish);
        // At least one more, so that failing runs cannot keep a study from reaching its cap.
        config.replications =
            std::min(std::max(round.next, config.replications + 1), config.precision->at_most);
    }
}

/// Records stay true when their scenario is edited; what is made from both does not.
void warn_of_changed_scenarios(const results::Store& store) try {
    study::require_unchanged(store);
} catch (const core::InputError& error) {
    fmt::print(stderr, "clearway: warning: {}\n", error.what());
}

core::ExitCode publish(const results::Store& store, const PublishOptions& options) {
    const results::Results results = results::read_results(store, results::VehicleRows::emergency);
    const analysis::Summary summary =
        analysis::summarise(results, analysis::usual_level, options.response_threshold_s);
    report::StudyFacts facts = report::facts_of(store, results, summary, options.least_relevant_s,
                                                condition_called(options.condition, store));
    require_replayable(store, results, facts, options.replays);
    const bool all_lost = is_all_lost(facts);
    if (all_lost) name_errors(store, results);
    for (report::ScenarioFacts& scenario : facts.scenarios)
        if (all_lost) scenario.outlook.clear();
    fmt::print("{}", options.printing == Printing::json ? report::json_tables(facts)
                                                        : report::console_tables(facts, options.tables));
    if (!all_lost) name_errors(store, results);
    tell_printed(store);
    warn_of_changed_scenarios(store);
    renew_edited_tables(store);
    if (!results::tables_are_current(store)) results::write_tables(store);
    write_report(facts, replays_of(store, results, facts, options.replays), store.folder() / "report.html");
    fmt::print(stderr, "clearway: written: {}\n", (store.folder() / "report.html").string());
    core::ExitCode code = tell_missing(results.missing.size(), results.manifest.run_count());
    if (code == core::ExitCode::ok && !results.errors.empty()) code = core::ExitCode::runs_failed;
    tell_failed(results, facts, code);
    return code;
}

}  // namespace clearway::campaign
