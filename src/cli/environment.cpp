#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "campaign/names.hpp"
#include "campaign/programs.hpp"
#include "campaign/study_run.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/files.hpp"
#include "experiment/conditions.hpp"
#include "experiment/job.hpp"
#include "experiment/related_conditions.hpp"
#include "experiment/settings.hpp"

namespace clearway::cli {
namespace {

struct EnvironmentArguments {
    std::string scenario;
    DescribedCondition described;
    scenario::Options options;
    std::uint64_t seed = 1;
    std::uint32_t replication = 0;
    std::uint32_t ways = 0;
    std::string folder;
    std::vector<int> channel;
};

/// The job of one replication of the condition.
experiment::RunJob job_of(const study::Plan& plan, const experiment::ConditionSpec& condition) {
    experiment::RunJob job = plan.units.front().unit;
    job.conditions = {condition};
    constexpr double any_s = 1e9;
    job.limits.wall_s = any_s;  // an episode waits for its agent as long as that takes
    return job;
}

/// An environment has policies besides its agent only where they are named; it runs no baseline.
core::ExitCode serve(const EnvironmentArguments& arguments, const Invocation& invocation) {
    experiment::ConditionSpec condition = condition_of(arguments.described);
    condition.name = experiment::described_name(condition);
    campaign::check_names({condition});
    study::StudyConfig config;
    config.seed = arguments.seed;
    config.replications = 1;
    config.scenarios = {scenario::load(arguments.scenario, arguments.options)};
    config.name = "environment";
    config.conditions = {experiment::baseline_for(condition)};
    campaign::RunOptions options;
    options.folder = arguments.folder;
    options.command = invocation.command;
    const study::Plan plan = campaign::plan_for(config, options);
    study::prepare_folder(plan, options.folder);
    experiment::RunJob job = job_of(plan, condition);
    job.replication = arguments.replication;
    const std::filesystem::path work = std::filesystem::absolute(options.folder) / "work" /
                                       fmt::format("environment-{}", arguments.replication);
    core::make_folder(work);
    const std::filesystem::path file = work / "job.json";
    core::write_atomically(file, experiment::to_json(job));
    std::vector<std::string> words = {"--episodes", file.string(), std::to_string(arguments.ways)};
    for (const int descriptor : arguments.channel)
        words.push_back(std::to_string(descriptor));
    campaign::become(campaign::sister_program("clearway-run"), words);
}

}  // namespace

Action configure_environment(App& app) {
    const auto arguments = std::make_shared<EnvironmentArguments>();
    add_scenario_argument(app, arguments->scenario);
    {
        const OptionGroup group(app, "What acts besides the agent, and how sensors fail");
        add_condition_options(app, arguments->described, "none");
    }
    add_seed_option(app, arguments->seed);
    app.add_option("--replication", arguments->replication, "Which replication of that seed")
        .option_text("N [0]");
    app.add_option("--ways", arguments->ways, "How many ways of the emergency vehicle the agent is offered")
        .option_text("N [0]");
    app.add_option("--out", arguments->folder, "Folder for its network and files")
        .required()
        .option_text("DIR (required)");
    app.add_option("--channel", arguments->channel, "Descriptors of the shared memory and of two pipes")
        .required()
        .expected(3)
        .option_text("MEMORY READ WRITE (required)");
    add_override_option(app, arguments->options);
    return [arguments](const Invocation& invocation) { return serve(*arguments, invocation); };
}

}  // namespace clearway::cli
