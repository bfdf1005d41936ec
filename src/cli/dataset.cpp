#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "campaign/names.hpp"
#include "campaign/printout.hpp"
#include "campaign/worker_jobs.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/own_output.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/dataset_job.hpp"
#include "prediction/repair_net.hpp"
#include "samples/dataset_plan.hpp"
#include "scenario/network.hpp"
#include "study/folder_lock.hpp"

namespace clearway::cli {
namespace {

struct DatasetArguments {
    std::string scenario;
    std::string folder;
    samples::DatasetSeeds seeds;
    unsigned jobs = 0;
    Printing printing = Printing::text;
    experiment::DatasetJob job;  ///< What all jobs share.
    std::vector<std::string> settings;
    scenario::Options options;
};

void check_failures(const std::vector<std::string>& failures) {
    std::vector<core::Problem> problems;
    for (const std::string& failure : failures) {
        campaign::check_failure("--failure", failure, problems);
        if (failure.find("exits") == std::string::npos) continue;
        // Files are named, and their samples labelled, by --exits.
        problems.push_back({fmt::format("--failure `{}`", failure), "sets `exits`, which has its own option",
                            "", "Give --exits known or --exits unknown"});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

/// Checks the policies and gives the job their settings.
void apply_policies(const std::vector<std::string>& settings, experiment::DatasetJob& job) {
    experiment::ConditionSpec condition;
    condition.name = "dataset";
    if (job.policies == std::vector<std::string>{"none"}) job.policies.clear();
    condition.policies = job.policies;
    experiment::resolve_parts(condition, {}, "--");
    job.policies = condition.policies;
    std::vector<core::Problem> problems;
    for (const std::string& words : settings) {
        const std::string name = assignment("--set", words).first;
        if (name.starts_with("failure.") || name == "loop.link_radius_m")
            problems.push_back({"--set " + name, "is not a setting of the policies, which know everything",
                                "", "Give the sensors of the samples with --failure"});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    apply_settings(settings, "", condition);
    campaign::check_names({condition});
    job.settings = condition.settings;
}

/// Of the lines `FILE: what it holds` of the workers.
campaign::Printout printout_of(const std::vector<std::string>& lines) {
    campaign::Table files{"files", {{"path", "file"}, {"content", "content"}}, {}};
    for (const std::string& line : lines) {
        const std::size_t end = line.find(": ");
        files.rows.push_back({{line.substr(0, end), end == std::string::npos ? "" : line.substr(end + 2)}});
    }
    return {.tables = {files}};
}

/// Data for nets and trees that take the radius as an input: only such as their trainings take.
void check_link_radius(const experiment::DatasetJob& job) {
    if (job.dataset != experiment::DatasetKind::repair) return;
    if (prediction::repair_radii.contains(job.link_radius_m)) return;
    throw core::InputError({"--link-radius", fmt::format("{} m with --net graphsage", job.link_radius_m),
                            fmt::format("{}, which `train graphsage` and `train gradient_boosting` take",
                                        text(prediction::repair_radii)),
                            ""});
}

core::ExitCode record(DatasetArguments arguments, const Invocation& invocation) {
    const bool many = arguments.job.dataset != experiment::DatasetKind::published;
    if (many && arguments.job.failures.empty()) arguments.job.failures = {"B10"};
    if (!many && arguments.seeds.count > 1) {
        throw core::InputError({"--seeds", fmt::format("{} for one snapshot", arguments.seeds.count),
                                "1, or --samples", "The published data set is a single snapshot"});
    }
    check_failures(arguments.job.failures);
    check_link_radius(arguments.job);
    apply_policies(arguments.settings, arguments.job);
    const scenario::ScenarioConfig config = scenario::load(arguments.scenario, arguments.options);
    arguments.job.output = arguments.folder;
    const std::vector<experiment::DatasetJob> jobs =
        samples::dataset_jobs(arguments.job, config.name, arguments.seeds);
    samples::check_folder(jobs, scenario::to_toml(config));
    if (std::filesystem::exists(std::filesystem::path(arguments.folder) / "manifest.json"))
        throw core::InputError({"--out", fmt::format("{} holds the runs of a study", arguments.folder),
                                "a folder of data sets, or a new one", "Choose another folder"});
    core::claim(arguments.folder, {"clearway links dataset", {".clearway-dataset"}});
    const study::FolderLock lock(arguments.folder);
    scenario::store(config, jobs.front().scenario_file.parent_path());
    scenario::build_network(config, jobs.front().network_folder);
    const campaign::WorkerResult result = campaign::record_jobs(jobs, arguments.jobs);
    campaign::print(printout_of(result.lines), arguments.printing);
    if (result.exit_code == core::ExitCode::interrupted || result.exit_code == core::ExitCode::terminated) {
        fmt::print(stderr,
                   "clearway: interrupted; what is complete is kept in {}. To record the rest:\n  {}\n",
                   arguments.folder, invocation.command);
    }
    return result.exit_code;
}

void add_published_options(App& app, experiment::DatasetJob& job, Option samples) {
    const OptionGroup group(app, "As published (three CSV files)");
    app.add_choice("--pairs", job.pairs,
                   {{"true-links", experiment::ListedPairs::true_links},
                    {"candidates", experiment::ListedPairs::candidates}},
                   "Pairs in the list: only linked ones, or all within reach")
        .option_text("true-links|candidates [candidates]")
        .excludes(samples);
    app.add_option("--features", job.feature_count, "Features of a vehicle: position alone, or all five")
        .one_of({2, 5})
        .option_text("2|5 [5]")
        .excludes(samples);
}

Option add_sample_options(App& app, DatasetArguments& arguments) {
    const OptionGroup group(app, "Many snapshots (for the other trainings)");
    experiment::DatasetJob& job = arguments.job;
    const Option samples = app.add_flag_callback(
        "--samples", [&job] { job.dataset = experiment::DatasetKind::samples; },
        "Inputs of predictors at many moments, with the true links [one snapshot]");
    app.add_choice("--net", job.dataset,
                   {{"corrected", experiment::DatasetKind::samples},
                    {"graphsage", experiment::DatasetKind::repair},
                    {"logistic", experiment::DatasetKind::pair_samples}},
                   "Predictor to record for: graphsage_corrected, graphsage or the pair model (CSV)")
        .option_text("corrected|graphsage|logistic [corrected]")
        .needs(samples);
    app.add_choice("--exits", job.exits, "Whether it is known that a vehicle has left the network")
        .option_text("known|unknown [known]")
        .needs(samples);
    app.add_option("--failure", job.failures, "Sensor failures, one file each (clearway list)")
        .option_text("NAME ... [B10]")
        .needs(samples);
    const Option policy =
        app.add_option("--policy", job.policies,
                       "Policies that act on the traffic, in this order; they know everything")
            .option_text("NAME ... [none]")
            .needs(samples);
    app.add_option("--set", arguments.settings, "A setting of the policies (clearway list settings)")
        .option_text("COMPONENT.NAME=VALUE ... [defaults]")
        .needs(policy);
    app.add_option("--interval", job.interval_s, "Simulation time between two snapshots, s")
        .range(0.1, 3600.0)
        .option_text(fmt::format("SECONDS, 0.1 to 3600 [{}]", job.interval_s))
        .needs(samples);
    for (const Option& option : add_link_options(app, job))
        option.needs(samples);
    return samples;
}

}  // namespace

Action configure_dataset(App& app) {
    const auto arguments = std::make_shared<DatasetArguments>();
    add_scenario_argument(app, arguments->scenario);
    app.add_option("--out", arguments->folder, "Folder of the data set; made when absent")
        .required()
        .option_text("DIR (required)");
    app.add_option("--seeds", arguments->seeds.count, "Replications to record; more than one with --samples")
        .range(1U, most_replications)
        .option_text(fmt::format("N, 1 to {} [1]", most_replications));
    app.add_option("--first-seed", arguments->seeds.first, "Number of the first replication")
        .range(0U, 4000000000U)
        .option_text("N, 0 to 4000000000 [0]");
    add_seed_option(app, arguments->job.study_seed);
    add_jobs_option(app, arguments->jobs);
    add_json_option(app, arguments->printing, "the list of files");
    const Option samples = add_sample_options(app, *arguments);
    add_published_options(app, arguments->job, samples);
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation& invocation) { return record(*arguments, invocation); };
}

}  // namespace clearway::cli
