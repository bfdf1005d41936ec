#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "campaign/run_plan.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {
namespace {

constexpr std::uint32_t usual_seeds = 20;  // the fewest that the dissertation's tables are printed from
constexpr std::uint32_t quick_seeds = 10;  // FHWA's minimum; about a minute on two cores

struct Arguments {
    std::uint32_t seeds = usual_seeds;
    std::uint64_t seed = 1;
    std::string folder;
    unsigned jobs = 0;
    experiment::RunLimits limits;
    Printing printing = Printing::text;
    report::Tables tables = report::Tables::essential;
    scenario::Options scenario;
};

/// `runs/reproduce` with a suffix for options that differ from the defaults, so that a quick try does not
/// block the whole study.
std::string folder_of(const Arguments& arguments) {
    if (!arguments.folder.empty()) return arguments.folder;
    std::string folder = "runs/reproduce";
    if (arguments.scenario.overrides.contains("variant")) folder += "-dense";
    if (arguments.seeds != usual_seeds) folder += fmt::format("-{}-seeds", arguments.seeds);
    return folder;
}

core::ExitCode reproduce(const Arguments& arguments, const Invocation& invocation) {
    campaign::RunPlanOptions options{.folder = folder_of(arguments),
                                     .workers = arguments.jobs,
                                     .limits = arguments.limits,
                                     .printing = arguments.printing,
                                     .command = invocation.command,
                                     .tables = arguments.tables};
    const study::Plan plan = campaign::plan_for(
        study::dissertation_study(arguments.seeds, arguments.seed, arguments.scenario), options);
    return campaign::run_and_print(plan, options);
}

}  // namespace

Action configure_reproduce(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::Option* const seeds = add_seeds_option(app, arguments->seeds);
    app.add_flag_callback(
           "--quick", [arguments] { arguments->seeds = quick_seeds; },
           fmt::format("{} seeds, FHWA's minimum: about a minute on two cores [off]", quick_seeds))
        ->excludes(seeds);
    add_seed_option(app, arguments->seed);
    app.add_option("--out", arguments->folder, "Run folder; a study that was interrupted there is continued")
        ->option_text("DIR [runs/reproduce, with the number of seeds unless it is 20]");
    add_jobs_option(app, arguments->jobs);
    add_limit_options(app, arguments->limits);
    add_json_option(app, arguments->printing, "the tables");
    add_tables_option(app, arguments->tables);
    add_scenario_options(app, arguments->scenario);
    return [arguments](const Invocation& invocation) { return reproduce(*arguments, invocation); };
}

}  // namespace clearway::cli
