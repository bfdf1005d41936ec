#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "campaign/fitness.hpp"
#include "campaign/run_plan.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "experiment/conditions.hpp"
#include "scenario/network.hpp"

namespace clearway::cli {
namespace {

struct Arguments {
    std::string scenario;
    std::uint64_t seed = 1;
    experiment::RunLimits limits;
    Printing printing = Printing::text;
    scenario::Options options;
};

void print(const std::vector<campaign::Finding>& findings, Printing printing) {
    if (printing == Printing::text) {
        for (const campaign::Finding& finding : findings) {
            fmt::print("{:8} {:11} {}\n", campaign::word_of(finding.grade), finding.name, finding.text);
            if (!finding.advice.empty()) fmt::print("{:20} try: {}\n", "", finding.advice);
        }
        return;
    }
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const campaign::Finding& finding : findings)
        rows.push_back({{"finding", finding.name},
                        {"grade", campaign::word_of(finding.grade)},
                        {"text", finding.text},
                        {"advice", finding.advice}});
    fmt::print("{}\n", rows.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

core::ExitCode exit_code_of(const std::vector<campaign::Finding>& findings) {
    const auto has = [&](campaign::Grade grade) {
        return std::ranges::any_of(findings,
                                   [&](const campaign::Finding& each) { return each.grade == grade; });
    };
    if (has(campaign::Grade::failed)) return core::ExitCode::runs_failed;
    return has(campaign::Grade::falls_short) ? core::ExitCode::fell_short : core::ExitCode::ok;
}

core::ExitCode check(const Arguments& arguments, const Invocation& invocation) {
    study::StudyConfig config;
    config.seed = arguments.seed;
    config.replications = 1;
    config.scenarios = {scenario::load(arguments.scenario, arguments.options)};
    const scenario::ScenarioConfig& scenario = config.scenarios.front();
    config.name = scenario.name;
    config.conditions = {experiment::built_in_condition("baseline", "check")};
    campaign::RunPlanOptions options{std::filesystem::path("runs") / ("check-" + scenario.name), 1,
                                     arguments.limits, arguments.printing, invocation.command};
    std::filesystem::remove_all(options.folder);
    const study::Plan plan = campaign::plan_for(config, options);
    const results::Store store = campaign::prepare_run_folder(plan, options);
    const auto started = std::chrono::steady_clock::now();
    const study::StudyResult result = campaign::run_missing(plan, store, options);
    if (campaign::was_interrupted(result)) return result.exit_code;
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();

    const experiment::RunKey key = plan.manifest.runs().front();
    std::vector<campaign::Finding> findings;
    if (const auto record = store.read(key)) {
        const std::filesystem::path& roads = plan.units.front().unit.network_folder;
        const scenario::BuiltNetwork built = scenario::open_network(scenario, roads);
        findings =
            campaign::findings_of(*record, {scenario, built.network, arguments.options.number("density", 1.0),
                                            store.scenario_folder(scenario.name) / "demand" / "0"});
        findings.push_back(
            {"speed", campaign::Grade::ok,
             fmt::format("{:.1f} times real time, including loading", record->metrics.simulated_s / wall_s)});
        const results::RunTiming timing = store.read_timing(key).value_or(results::RunTiming{});
        findings.push_back({"memory", campaign::Grade::ok, fmt::format("{} MiB", timing.peak_kib / 1024)});
        std::filesystem::remove_all(options.folder);
    } else {
        findings = {
            campaign::error_finding(store.read_error(key).value_or(results::RunError{}), options.folder)};
    }
    print(findings, arguments.printing);
    return exit_code_of(findings);
}

}  // namespace

Action configure_check(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("scenario", arguments->scenario, "Name (clearway list), folder or TOML file")
        ->required()
        ->option_text("SCENARIO (required)");
    add_seed_option(app, arguments->seed);
    add_limit_options(app, arguments->limits);
    add_json_option(app, arguments->printing, "the findings");
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation& invocation) { return check(*arguments, invocation); };
}

}  // namespace clearway::cli
