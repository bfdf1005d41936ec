#include "campaign/live.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "experiment/conditions.hpp"
#include "experiment/related_conditions.hpp"

namespace clearway::cli {
namespace {

struct LiveArguments {
    std::string scenario;
    ConditionWords conditions;
    std::string against = "baseline";
    std::uint64_t seed = 1;
    scenario::Options options;
    campaign::RunOptions run;
    server::LiveConfig server;
};

void require_traffic(const experiment::ConditionSpec& condition) {
    if (condition.traffic_model != experiment::TrafficModel::free_flow) return;
    throw core::InputError({"live", fmt::format("{} has no traffic to watch", condition.name),
                            "a condition with traffic", "clearway run computes the solo time"});
}

/// The conditions to watch: the other one first, so that it is left.
std::vector<experiment::ConditionSpec> watched(const LiveArguments& arguments) {
    const experiment::ConditionSpec shown = shown_condition(chosen_conditions(arguments.conditions), "live");
    std::vector<experiment::ConditionSpec> all;
    if (arguments.against == "baseline") {
        if (!shown.policies.empty()) all.push_back(experiment::baseline_for(shown));
    } else if (arguments.against != "none") {
        all.push_back(experiment::built_in_condition(arguments.against, "--against"));
    }
    add_once(all, shown);
    for (const experiment::ConditionSpec& condition : all)
        require_traffic(condition);
    return all;
}

study::StudyConfig study_of(const LiveArguments& arguments,
                            const std::vector<experiment::ConditionSpec>& watched) {
    std::vector<experiment::ConditionSpec> all;
    for (const experiment::ConditionSpec& condition : watched) {
        if (!condition.policies.empty()) add_once(all, experiment::baseline_for(condition));
    }
    for (const experiment::ConditionSpec& condition : watched)
        add_once(all, condition);
    return campaign::study_of(scenario::load(arguments.scenario, arguments.options), all, arguments.seed, 1);
}

core::ExitCode live(const LiveArguments& arguments, const Invocation& invocation) {
    const std::vector<experiment::ConditionSpec> conditions = watched(arguments);
    campaign::LiveRequest request{study_of(arguments, conditions), conditions, arguments.server,
                                  arguments.run};
    request.run.command = invocation.command;
    return campaign::run_live(std::move(request));
}

void add_server_options(App& app, const std::shared_ptr<LiveArguments>& arguments) {
    const OptionGroup group(app, "The server");
    server::LiveConfig& server = arguments->server;
    app.add_option("--host", server.host,
                   "Address or name to listen at; beyond this machine a token is needed")
        .option_text(fmt::format("ADDRESS [{}]", server.host));
    app.add_option("--port", server.port, "Port to listen at; 0: any that is free")
        .range(0.0, 65535.0)
        .option_text(fmt::format("PORT, 0 to 65535 [{}]", server.port));
    app.add_option("--token", server.token,
                   "What viewers must know beyond this machine; at this machine only if given")
        .option_text("TEXT, 16 to 128 letters [random beyond this machine]");
    app.add_flag("--allow-control", server.allow_control, "Let viewers pause, step and set the speed [off]");
    constexpr double fastest = 1000.0;
    app.add_option("--speed", server.speed, "Times real time; 0: as fast as possible")
        .range(0.0, fastest)
        .option_text(fmt::format("NUMBER, 0 to {:g} [{:g}]", fastest, server.speed));
}

}  // namespace

Action configure_live(App& app) {
    const auto arguments = std::make_shared<LiveArguments>();
    add_scenario_argument(app, arguments->scenario);
    add_condition_words(app, arguments->conditions);
    app.add_option("--against", arguments->against, "What is shown beside it: a built-in condition, or none")
        .option_text("NAME|none [baseline]");
    add_seed_option(app, arguments->seed);
    app.add_option("--out", arguments->run.folder, "Run folder")
        .option_text("DIR [runs/SCENARIO-xxxxxx, a hash of what is run]");
    add_json_option(app, arguments->run.publish.printing, "the tables");
    add_tables_option(app, arguments->run.publish.tables);
    add_own_condition_options(app, arguments->conditions.own);
    add_scenario_options(app, arguments->options);
    add_server_options(app, arguments);
    return [arguments](const Invocation& invocation) { return live(*arguments, invocation); };
}

}  // namespace clearway::cli
