#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "campaign/plan_text.hpp"
#include "campaign/shown_run.hpp"
#include "campaign/study_run.hpp"
#include "campaign/time_budget.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/interruption.hpp"
#include "experiment/conditions.hpp"
#include "experiment/related_conditions.hpp"

namespace clearway::cli {
namespace {

enum class Floor : std::uint8_t { solo, none };
/// Whether a condition of the user's own whose sensors or messages fail runs while nothing fails, too.
enum class Ceiling : std::uint8_t { perfect, none };

struct RunArguments {
    std::string scenario;
    ConditionWords conditions;
    Floor floor = Floor::solo;
    Ceiling ceiling = Ceiling::perfect;
    std::uint32_t seeds = usual_seeds;
    double within_s = 0.0;  ///< 0: no time is given.
    std::uint64_t seed = 1;
    std::uint64_t most_runs = results::usual_most_runs;
    campaign::RunOptions run;
    scenario::Options options;
    bool is_shown = false;
    bool is_planned = false;  ///< Only.
    double delay_ms = 50.0;   ///< With steps of 0.25 s: five times real time.
    std::string window_settings;
};

/// The chosen conditions, or else the usual one, with their baselines and solo.
std::vector<experiment::ConditionSpec> conditions_of(const RunArguments& arguments,
                                                     std::vector<experiment::ConditionSpec> chosen) {
    if (chosen.empty())
        chosen.push_back(experiment::built_in_condition(experiment::usual_condition, "--condition"));
    std::vector<experiment::ConditionSpec> all;
    for (const experiment::ConditionSpec& condition : chosen) {
        if (condition.traffic_model != experiment::TrafficModel::free_flow)
            add_once(all, experiment::baseline_for(condition));
    }
    for (const experiment::ConditionSpec& condition : chosen) {
        add_once(all, condition);
    }
    if (arguments.floor == Floor::solo) {
        add_once(all, experiment::built_in_condition("solo", "--condition"));
    } else {
        std::erase_if(all, [](const auto& condition) {
            return condition.traffic_model == experiment::TrafficModel::free_flow;
        });
    }
    return all;
}

/// Puts the same condition while nothing fails before one of the user's own that acts and fails: a control.
void add_ceiling(study::StudyConfig& study) {
    const auto own = std::ranges::find_if(study.conditions, [](const experiment::ConditionSpec& condition) {
        return condition.acts() && !experiment::takes_built_in_name(condition);
    });
    if (own == study.conditions.end()) return;
    const experiment::ConditionSpec perfect = experiment::without_failure(*own);
    if (core::contains(study.conditions, perfect.name, &experiment::ConditionSpec::name)) return;
    study.controls[perfect.name] = own->name;
    study.conditions.insert(own, perfect);
}

/// A regular file, or empty: Clearway's own settings.
std::filesystem::path window_settings(const std::string& file) {
    if (file.empty()) return {};
    if (std::filesystem::is_regular_file(file)) return std::filesystem::absolute(file);
    throw core::InputError({"--gui-settings-file", fmt::format("{} is not a file", file),
                            "view settings of sumo-gui (its Edit Visualization window saves them)", ""});
}

/// Several policies are one condition, which who wants to compare them does not see.
void tell_combined(const std::vector<std::string>& policies) {
    if (policies.size() < 2) return;
    fmt::print(stderr,
               "clearway: one condition of {} policies: {}; to compare them: a study file with a "
               "[[condition]] for each (docs/guides/your-study.md)\n",
               policies.size(), core::listed(policies));
}

core::ExitCode run(const RunArguments& arguments, const Invocation& invocation) {
    tell_combined(arguments.conditions.own.condition.policies);
    std::optional<core::InterruptionNotice> notice;
    if (!arguments.is_shown) notice.emplace(campaign::interrupted_between_runs(invocation.command));
    campaign::RunOptions options = arguments.run;
    options.command = invocation.command;
    const auto study_of = [&](std::vector<experiment::ConditionSpec> conditions) {
        study::StudyConfig study = campaign::study_of(scenario::load(arguments.scenario, arguments.options),
                                                      conditions_of(arguments, std::move(conditions)),
                                                      arguments.seed, arguments.seeds);
        study.most_runs = arguments.most_runs;
        if (arguments.ceiling == Ceiling::perfect && !arguments.is_shown) add_ceiling(study);
        return study;
    };
    const std::vector<experiment::ConditionSpec> chosen = chosen_conditions(arguments.conditions);
    const bool is_timed = arguments.within_s > 0.0;
    if (arguments.is_planned) {
        study::StudyConfig planned = study_of(chosen);
        if (is_timed) planned = campaign::fitted(std::move(planned), arguments.within_s, options);
        return campaign::print_plan(planned, {}, options);
    }
    if (!arguments.is_shown) {
        return is_timed ? campaign::run_within(study_of(chosen), arguments.within_s, options)
                        : campaign::run_study(study_of(chosen), options);
    }
    const experiment::ConditionSpec shown = shown_condition(chosen, "--gui");
    const experiment::WindowSpec window{.delay_s = arguments.delay_ms / 1000.0,
                                        .settings_file = window_settings(arguments.window_settings)};
    const study::Plan plan = campaign::plan_for(study_of({shown}), options);
    return campaign::show_and_print(plan, options, shown, window);
}

void add_window_options(App& app, const std::shared_ptr<RunArguments>& arguments) {
    const OptionGroup group(app, "A window");
    const Option gui = app.add_flag("--gui", arguments->is_shown,
                                    fmt::format("Show the first seed of one condition [{}] in sumo-gui",
                                                experiment::usual_condition))
                           .excludes("--dry-run")
                           .excludes("--within");
    constexpr double longest_delay_ms = 60000.0;
    app.add_option("--gui-delay", arguments->delay_ms,
                   "Minimum wall time per step, from a minute before the first emergency vehicle, ms")
        .range(0.0, longest_delay_ms)
        .option_text(fmt::format("MS, 0 to {:g} [{:g}]", longest_delay_ms, arguments->delay_ms))
        .needs(gui);
    app.add_option("--gui-settings-file", arguments->window_settings, "View settings of sumo-gui")
        .option_text("FILE [Clearway's own]")
        .needs(gui);
}

}  // namespace

Action configure_run(App& app) {
    const auto arguments = std::make_shared<RunArguments>();
    add_scenario_argument(app, arguments->scenario);
    add_condition_words(app, arguments->conditions);
    app.add_flag_callback(
        "--no-solo", [arguments] { arguments->floor = Floor::none; },
        "Leave out the runs of emergency vehicles alone and the gap closed [with them]");
    app.add_flag_callback(
        "--no-perfect", [arguments] { arguments->ceiling = Ceiling::none; },
        "Leave out the condition of your own while nothing fails, which says what --failure costs [with it]");
    const Option seeds = add_seeds_option(app, arguments->seeds);
    add_within_option(app, arguments->within_s).excludes(seeds);
    add_seed_option(app, arguments->seed);
    add_most_runs_option(app, arguments->most_runs);
    app.add_option("--out", arguments->run.folder,
                   "Run folder; a study that was interrupted there is continued")
        .option_text("DIR [runs/SCENARIO-xxxxxx, a hash of what is run]");
    app.add_flag("--dry-run", arguments->is_planned,
                 "Print cells, runs, estimated time and disk, and run nothing [off]");
    add_jobs_option(app, arguments->run.workers);
    add_record_option(app, arguments->run.recording);
    add_limit_options(app, arguments->run.limits);
    add_retry_option(app, arguments->run.retried);
    add_json_option(app, arguments->run.publish.printing, "the tables");
    add_tables_option(app, arguments->run.publish.tables);
    add_response_option(app, arguments->run.publish.response_threshold_s);
    add_own_condition_options(app, arguments->conditions.own);
    add_scenario_options(app, arguments->options);
    add_window_options(app, arguments);
    app.set_everyday({"--condition", "--policy", "--failure", "--seeds", "--within", "--density",
                      "--av-share", "--out", "--dry-run", "--record"});
    return [arguments, seeds](const Invocation& invocation) {
        if (arguments->is_shown && seeds.count() == 0) arguments->seeds = 1;
        return run(*arguments, invocation);
    };
}

}  // namespace clearway::cli
