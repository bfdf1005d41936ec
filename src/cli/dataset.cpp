#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/common_options.hpp"
#include "cli/names.hpp"
#include "cli/scenario_options.hpp"
#include "cli/verb.hpp"
#include "cli/worker_jobs.hpp"
#include "core/files.hpp"
#include "core/number_range.hpp"
#include "experiment/dataset_job.hpp"
#include "samples/dataset_files.hpp"
#include "samples/graph_sample.hpp"
#include "samples/pair_samples.hpp"
#include "scenario/network.hpp"

namespace clearway::cli {
namespace {

struct Arguments {
    std::string scenario;
    std::string folder;
    std::uint32_t first_seed = 0;
    std::uint32_t seeds = 1;
    unsigned jobs = 0;
    Printing printing = Printing::text;
    experiment::DatasetJob job;  ///< What all jobs share.
    scenario::Options options;
};

void check_failures(const std::vector<std::string>& failures) {
    std::vector<core::Problem> problems;
    for (const std::string& failure : failures) {
        check_failure("--failure", failure, problems);
        if (failure.find("exits") == std::string::npos) continue;
        // Files are named, and their samples labelled, by --exits.
        problems.push_back({fmt::format("--failure `{}`", failure), "sets `exits`, which has its own option",
                            "", "Give --exits known or --exits unknown"});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

/// Where a job is kept beside the data set.
std::filesystem::path job_file(const experiment::DatasetJob& job) {
    return job.scenario_file.parent_path() / "jobs" / fmt::format("{:04}.json", job.replication);
}

/// One job per replication, on a scenario and network below `origin/` of the data set.
std::vector<experiment::DatasetJob> make_jobs(const Arguments& arguments, const std::string& scenario) {
    experiment::DatasetJob job = arguments.job;
    job.scenario = scenario;
    job.output = arguments.folder;
    const std::filesystem::path origin = job.output / "origin" / scenario;
    job.scenario_file = origin / "scenario.toml";
    job.network_folder = origin / "network";
    std::vector<experiment::DatasetJob> jobs;
    for (std::uint32_t i = 0; i < arguments.seeds; ++i) {
        job.replication = arguments.first_seed + i;
        jobs.push_back(job);
    }
    return jobs;
}

/// What a job will write.
std::vector<std::filesystem::path> files_of(const experiment::DatasetJob& job) {
    if (job.dataset == experiment::DatasetKind::published) {
        return {job.output / samples::edge_list_file, job.output / samples::vehicle_features_file,
                job.output / samples::target_file};
    }
    const char* const ending = job.dataset == experiment::DatasetKind::pair_samples
                                   ? samples::pair_sample_ending
                                   : samples::graph_sample_extension;
    std::vector<std::filesystem::path> files;
    for (const std::string& failure : job.failures)
        files.push_back(experiment::sample_file(job, failure, ending));
    return files;
}

bool holds(const std::filesystem::path& file, const std::string& text) {
    return std::filesystem::exists(file) && core::read_file(file) == text;
}

/// Refuses a folder in which recordings of others would be lost. The same command may be given again.
void check_folder(const std::vector<experiment::DatasetJob>& jobs, const std::string& scenario) {
    const char* const cure = "Record into another --out, or remove what is there";
    const std::filesystem::path& scenario_file = jobs.front().scenario_file;
    if (std::filesystem::exists(scenario_file) && !holds(scenario_file, scenario)) {
        throw core::InputError(
            {scenario_file.string(),
             fmt::format("another configuration of {} was recorded here", jobs.front().scenario),
             "one for each scenario of a data set", cure});
    }
    std::vector<std::string> taken;
    for (const experiment::DatasetJob& job : jobs) {
        if (holds(job_file(job), experiment::to_json(job))) continue;
        for (const std::filesystem::path& file : files_of(job)) {
            if (std::filesystem::exists(file)) taken.push_back(file.string());
        }
    }
    if (taken.empty()) return;
    const std::string more = taken.size() == 1 ? "" : fmt::format(", and {} more", taken.size() - 1);
    throw core::InputError({taken.front(), "is there already, of another recording" + more, "", cure});
}

/// The lines are what the workers said about their files, by replication. Job files and logs stand beside the
/// scenario file.
WorkerResult record_all(const std::vector<experiment::DatasetJob>& jobs, unsigned processes) {
    std::vector<WorkerJob> work;
    for (const experiment::DatasetJob& job : jobs) {
        const std::filesystem::path file = job_file(job);
        work.push_back({.label = fmt::format("{} replication {}", job.scenario, job.replication),
                        .job = job,
                        .file = file,
                        .log = std::filesystem::path(file).replace_extension(".log"),
                        .work = job.output / fmt::format("work-{}-{}", job.scenario, job.replication)});
    }
    return work_on(work, processes, "recordings");
}

void print_files(const std::vector<std::string>& lines, Printing printing) {
    if (printing == Printing::text) {
        for (const std::string& line : lines) {
            fmt::print("{}\n", line);
        }
        return;
    }
    nlohmann::json files = nlohmann::json::array();
    for (const std::string& line : lines) {
        const std::size_t end = line.find(": ");
        files.push_back({{"path", line.substr(0, end)},
                         {"content", end == std::string::npos ? "" : line.substr(end + 2)}});
    }
    fmt::print("{}\n", nlohmann::json({{"files", std::move(files)}}).dump(2));
}

core::ExitCode record(Arguments arguments, const Invocation& invocation) {
    const bool samples = arguments.job.dataset != experiment::DatasetKind::published;
    if (samples && arguments.job.failures.empty()) arguments.job.failures = {"B10"};
    if (!samples && arguments.seeds > 1) {
        throw core::InputError({"--seeds", fmt::format("{} for one snapshot", arguments.seeds),
                                "1, or --samples", "The published data set is a single snapshot"});
    }
    check_failures(arguments.job.failures);
    const scenario::ScenarioConfig config = scenario::load(arguments.scenario, arguments.options);
    const std::vector<experiment::DatasetJob> jobs = make_jobs(arguments, config.name);
    check_folder(jobs, scenario::to_toml(config));
    scenario::store(config, jobs.front().scenario_file.parent_path());
    scenario::build_network(config, jobs.front().network_folder);
    const WorkerResult result = record_all(jobs, arguments.jobs);
    print_files(result.lines, arguments.printing);
    if (result.exit_code == core::ExitCode::interrupted || result.exit_code == core::ExitCode::terminated) {
        fmt::print(stderr,
                   "clearway: interrupted; what is complete is kept in {}. To record the rest again:\n  {}\n",
                   arguments.folder, invocation.command);
    }
    return result.exit_code;
}

void add_published_options(CLI::App& app, experiment::DatasetJob& job, CLI::Option* samples) {
    const char* const group = "As published (three CSV files)";
    static const std::map<std::string, experiment::ListedPairs> pairs = {
        {"true-links", experiment::ListedPairs::true_links},
        {"candidates", experiment::ListedPairs::candidates}};
    app.add_option_function<std::string>(
           "--pairs", [&job](const std::string& name) { job.pairs = pairs.at(name); },
           "Pairs in the list: only linked ones, or all within reach")
        ->check(CLI::IsMember(pairs))
        ->option_text("true-links|candidates [candidates]")
        ->excludes(samples)
        ->group(group);
    app.add_option("--features", job.feature_count, "Features of a vehicle: position alone, or all five")
        ->check(CLI::IsMember({2, 5}))
        ->option_text("2|5 [5]")
        ->excludes(samples)
        ->group(group);
}

CLI::Option* add_sample_options(CLI::App& app, Arguments& arguments) {
    const char* const group = "Many snapshots (for the other trainings)";
    experiment::DatasetJob& job = arguments.job;
    CLI::Option* const samples =
        app.add_flag_callback(
               "--samples", [&job] { job.dataset = experiment::DatasetKind::samples; },
               "What predictors are given at many moments, and the answers [one snapshot]")
            ->group(group);
    static const std::map<std::string, experiment::DatasetKind> nets = {
        {"corrected", experiment::DatasetKind::samples},
        {"graphsage", experiment::DatasetKind::repair},
        {"logistic", experiment::DatasetKind::pair_samples}};
    app.add_option_function<std::string>(
           "--net", [&job](const std::string& name) { job.dataset = nets.at(name); },
           "Whose inputs: graphsage_corrected's, graphsage's or the pair model's (as CSV)")
        ->check(CLI::IsMember(nets))
        ->option_text("corrected|graphsage|logistic [corrected]")
        ->needs(samples)
        ->group(group);
    app.add_option("--exits", job.exits, "Whether it is known when a vehicle leaves the network")
        ->check(CLI::IsMember({"known", "unknown"}))
        ->option_text("known|unknown [known]")
        ->needs(samples)
        ->group(group);
    app.add_option("--failure", job.failures, "Sensor failures, one file each (clearway list)")
        ->option_text("NAME ... [B10]")
        ->needs(samples)
        ->group(group);
    app.add_option("--interval", job.interval_s, "Simulation time between two snapshots, s")
        ->check(core::NumberRange{0.1, 3600.0})
        ->option_text(fmt::format("SECONDS, 0.1 to 3600 [{}]", job.interval_s))
        ->needs(samples)
        ->group(group);
    return samples;
}

}  // namespace

Action configure_dataset(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("scenario", arguments->scenario, "Name (clearway list), folder or TOML file")
        ->required()
        ->option_text("SCENARIO (required)");
    app.add_option("--out", arguments->folder, "Folder of the data set; made when absent")
        ->required()
        ->option_text("DIR (required)");
    app.add_option("--seeds", arguments->seeds, "Replications to record; more than one with --samples")
        ->check(CLI::Range(1U, most_replications))
        ->option_text(fmt::format("N, 1 to {} [1]", most_replications));
    app.add_option("--first-seed", arguments->first_seed, "Number of the first replication")
        ->check(CLI::Range(0U, 4000000000U))
        ->option_text("N, 0 to 4000000000 [0]");
    add_seed_option(app, arguments->job.study_seed);
    add_jobs_option(app, arguments->jobs);
    add_json_option(app, arguments->printing, "the list of files");
    CLI::Option* const samples = add_sample_options(app, *arguments);
    add_published_options(app, arguments->job, samples);
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation& invocation) { return record(*arguments, invocation); };
}

}  // namespace clearway::cli
