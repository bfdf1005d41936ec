#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/detail/condition_options.hpp"
#include "cli/detail/run_plan.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/detail/shown_run.hpp"
#include "cli/verb.hpp"
#include "core/number_range.hpp"
#include "experiment/conditions.hpp"
#include "experiment/settings.hpp"

namespace clearway::cli {
namespace {

enum class Floor : std::uint8_t { solo, none };

constexpr std::uint32_t usual_seeds = 10;  // FHWA's minimum number of replications

struct Arguments {
    std::string scenario;
    std::vector<std::string> conditions;  ///< Built-in ones, by name.
    DescribedCondition own;               ///< Without a name it is named after its content.
    Floor floor = Floor::solo;
    std::uint32_t seeds = usual_seeds;
    std::uint64_t seed = 1;
    std::string folder;
    unsigned jobs = 0;
    experiment::StepRecording recording = experiment::StepRecording::off;
    experiment::RunLimits limits;
    Printing printing = Printing::text;
    report::Tables tables = report::Tables::essential;
    scenario::Options options;
    bool is_shown = false;
    double delay_ms = 50.0;  ///< With steps of 0.25 s: five times real time.
    std::string window_settings;
};

/// Whether any option describes a condition of the user's own.
bool has_own_condition(const experiment::ConditionSpec& own) {
    experiment::ConditionSpec untouched;
    untouched.name = own.name;
    return own != untouched;
}

void add_once(std::vector<experiment::ConditionSpec>& conditions,
              const experiment::ConditionSpec& condition) {
    const auto same_name = [&](const auto& other) { return other.name == condition.name; };
    if (std::ranges::none_of(conditions, same_name)) conditions.push_back(condition);
}

/// The condition that the options describe. Without --policy they change the one that is named with
/// --condition, or else the usual one; `--policy none` and device.bluelight mean the car-following model
/// alone.
experiment::ConditionSpec own_condition(const Arguments& arguments,
                                        const std::vector<experiment::ConditionSpec>& chosen) {
    DescribedCondition described = arguments.own;
    experiment::ConditionSpec& own = described.condition;
    const bool names_policies = !own.policies.empty();
    const bool changes = has_own_condition(condition_of(described));
    if (names_policies || !changes || own.bluelight == traffic::BlueLight::on || chosen.size() > 1)
        return condition_of(described);
    const experiment::ConditionSpec base =
        chosen.empty() ? experiment::built_in_condition(experiment::usual_condition, "--condition")
                       : chosen.front();
    const experiment::ConditionSpec untouched;
    own.policies = base.policies;
    if (own.failure == untouched.failure) own.failure = base.failure;
    if (own.predictor == untouched.predictor) own.predictor = base.predictor;
    return condition_of(described);
}

/// The conditions that the user names or describes.
std::vector<experiment::ConditionSpec> chosen_conditions(const Arguments& arguments) {
    std::vector<experiment::ConditionSpec> chosen;
    for (const std::string& name : arguments.conditions) {
        add_once(chosen, experiment::built_in_condition(name, "--condition"));
    }
    experiment::ConditionSpec own = own_condition(arguments, chosen);
    if (has_own_condition(own)) {
        if (own.name.empty()) own.name = experiment::described_name(own);
        if (experiment::takes_built_in_name(own))
            throw core::InputError(
                {"--name", fmt::format("`{}` is a built-in condition", own.name), "", "Choose another name"});
        add_once(chosen, own);
    }
    return chosen;
}

/// The chosen conditions, or else the usual one, with their baselines and solo.
std::vector<experiment::ConditionSpec> conditions_of(const Arguments& arguments,
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

/// The chosen condition that a window shows.
experiment::ConditionSpec shown_condition(const std::vector<experiment::ConditionSpec>& chosen) {
    if (chosen.empty()) return experiment::built_in_condition(experiment::usual_condition, "--gui");
    if (chosen.size() == 1) return chosen.front();
    std::vector<std::string> names;
    for (const experiment::ConditionSpec& condition : chosen)
        names.push_back(condition.name);
    throw core::InputError({"--gui", fmt::format("cannot show {} at once", core::listed(names)),
                            "one condition",
                            "Name one with --condition, or describe one of your own (--policy ...)"});
}

/// A regular file, or empty: Clearway's own settings.
std::filesystem::path window_settings(const std::string& file) {
    if (file.empty()) return {};
    if (std::filesystem::is_regular_file(file)) return std::filesystem::absolute(file);
    throw core::InputError({"--gui-settings-file", fmt::format("{} is not a file", file),
                            "view settings of sumo-gui (its Edit Visualization window saves them)", ""});
}

study::StudyConfig study_of(const Arguments& arguments, std::vector<experiment::ConditionSpec> chosen) {
    study::StudyConfig config;
    config.seed = arguments.seed;
    config.replications = arguments.seeds;
    config.scenarios = {scenario::load(arguments.scenario, arguments.options)};
    config.name = config.scenarios.front().name;
    config.conditions = conditions_of(arguments, std::move(chosen));
    return config;
}

core::ExitCode run(const Arguments& arguments, const Invocation& invocation) {
    RunPlanOptions options{arguments.folder,   arguments.jobs,      arguments.limits, arguments.printing,
                           invocation.command, arguments.recording, arguments.tables};
    const std::vector<experiment::ConditionSpec> chosen = chosen_conditions(arguments);
    if (!arguments.is_shown) return run_and_print(plan_for(study_of(arguments, chosen), options), options);
    const experiment::ConditionSpec shown = shown_condition(chosen);
    const experiment::WindowSpec window{.delay_s = arguments.delay_ms / 1000.0,
                                        .settings_file = window_settings(arguments.window_settings)};
    const study::Plan plan = plan_for(study_of(arguments, {shown}), options);
    return show_and_print(plan, options, shown, window);
}

void add_window_options(CLI::App& app, const std::shared_ptr<Arguments>& arguments) {
    const char* const group = "A window";
    CLI::Option* const gui = app.add_flag("--gui", arguments->is_shown,
                                          fmt::format("Show the first seed of one condition [{}] in sumo-gui",
                                                      experiment::usual_condition))
                                 ->group(group);
    constexpr double longest_delay_ms = 60000.0;
    app.add_option("--gui-delay", arguments->delay_ms,
                   "Minimum wall time per step, from a minute before the first emergency vehicle, ms")
        ->check(core::NumberRange{0.0, longest_delay_ms})
        ->option_text(fmt::format("MS, 0 to {:g} [{:g}]", longest_delay_ms, arguments->delay_ms))
        ->needs(gui)
        ->group(group);
    app.add_option("--gui-settings-file", arguments->window_settings, "View settings of sumo-gui")
        ->option_text("FILE [Clearway's own]")
        ->needs(gui)
        ->group(group);
}

void add_own_condition_options(CLI::App& app, const std::shared_ptr<Arguments>& arguments) {
    const char* const group = "A condition of your own (names: clearway list)";
    add_condition_options(app, arguments->own, experiment::usual_condition, group);
    experiment::ConditionSpec& own = arguments->own.condition;
    add_switch(app, "--bluelight", own.bluelight,
               "SUMO's device.bluelight on every emergency vehicle, for comparison")
        ->option_text("on|off [off]")
        ->group(group);
    static const std::map<std::string, experiment::TrafficModel> models = {
        {"standard", experiment::TrafficModel::standard}, {"sublane", experiment::TrafficModel::sublane}};
    app.add_option_function<std::string>(
           "--traffic-model", [&own](const std::string& name) { own.traffic_model = models.at(name); },
           "SUMO's lateral model; sublane adds a baseline of its own")
        ->check(CLI::IsMember(models))
        ->option_text("standard|sublane [standard]")
        ->group(group);
    app.add_option("--name", own.name, "Its name in tables and folders")
        ->option_text("NAME [after its content: corridor_B10_graphsage]")
        ->group(group);
}

}  // namespace

Action configure_run(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("scenario", arguments->scenario, "Name (clearway list), folder or TOML file")
        ->required()
        ->option_text("SCENARIO (required)");
    app.add_option("--condition", arguments->conditions,
                   "A built-in condition; can be repeated. A baseline is always added")
        ->option_text(
            fmt::format("NAME ... [{}, unless one of your own is described]", experiment::usual_condition));
    app.add_flag_callback(
        "--no-solo", [arguments] { arguments->floor = Floor::none; },
        "Leave out the runs of emergency vehicles alone and the gap closed [with them]");
    const CLI::Option* const seeds = add_seeds_option(app, arguments->seeds);
    add_seed_option(app, arguments->seed);
    app.add_option("--out", arguments->folder, "Run folder; a study that was interrupted there is continued")
        ->option_text("DIR [runs/SCENARIO-xxxxxx, a hash of what is run]");
    add_jobs_option(app, arguments->jobs);
    add_record_option(app, arguments->recording);
    add_limit_options(app, arguments->limits);
    add_json_option(app, arguments->printing, "the tables");
    add_tables_option(app, arguments->tables);
    add_own_condition_options(app, arguments);
    add_scenario_options(app, arguments->options);
    add_window_options(app, arguments);
    return [arguments, seeds](const Invocation& invocation) {
        if (arguments->is_shown && seeds->count() == 0) arguments->seeds = 1;
        return run(*arguments, invocation);
    };
}

}  // namespace clearway::cli
