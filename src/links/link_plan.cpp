#include "links/link_plan.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/progress.hpp"
#include "links/link_run.hpp"
#include "scenario/network.hpp"

namespace clearway::links {
namespace {

namespace fs = std::filesystem;

/// Predictors that are not learned, strongest first.
constexpr std::array opponents = {"route_rule", "kalman", "dead_reckoning", "last_seen", "none"};

std::vector<std::uint32_t> replications(const SeedRange& range) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < range.count; ++i)
        numbers.push_back(range.first + i);
    return numbers;
}

/// All replications that the plan needs.
std::vector<std::uint32_t> replications(const LinkPlan& plan) {
    std::vector<std::uint32_t> numbers = replications(plan.benchmark.validation);
    if (plan.split == LinkSplit::test) {
        const std::vector<std::uint32_t> test = replications(plan.benchmark.test);
        numbers.insert(numbers.end(), test.begin(), test.end());
    }
    return numbers;
}

std::vector<experiment::JudgedPredictor> missing_predictors(const LinkPlan& plan, const LinkRunFiles& files,
                                                            const BenchmarkScenario& entry,
                                                            std::uint32_t replication) {
    std::vector<experiment::JudgedPredictor> jobs;
    for (const LinkPredictor& predictor : plan.predictors) {
        const fs::path file = files.file(entry, replication, predictor);
        if (fs::exists(file) && fs::exists(timing_file(file))) continue;
        const fs::path model = predictor.model_file.empty() ? fs::path() : fs::absolute(predictor.model_file);
        core::Settings settings = predictor.settings;
        if (plan.benchmark.candidates == prediction::CandidateReach::reported)
            settings.emplace("reach_by_twin", "0");
        jobs.push_back({predictor.name, model.string(), settings, file, predictor.part});
    }
    return jobs;
}

/// The missing runs of a scenario.
std::vector<experiment::LinkJob> missing_of(const LinkPlan& plan, const LinkRunFiles& files,
                                            const BenchmarkScenario& entry) {
    const fs::path folder = files.scenario_folder(entry.config);
    std::vector<experiment::LinkJob> jobs;
    for (const std::uint32_t replication : replications(plan)) {
        experiment::LinkJob job;
        job.predictors = missing_predictors(plan, files, entry, replication);
        if (job.predictors.empty()) continue;
        job.scenario = entry.label;
        job.policy = entry.policy;
        job.scenario_file = folder / "scenario.toml";
        job.network_folder = folder / "network";
        job.study_seed = plan.benchmark.study_seed;
        job.replication = replication;
        job.work_folder = plan.folder / "work" /
                          fmt::format("{}-{}.{}{}", entry.label, replication, ::getpid(), core::part_ending);
        job.failures = plan.benchmark.failures;
        job.exits = plan.benchmark.exits;
        static_cast<experiment::LinkSettings&>(job) = plan.benchmark.links;
        jobs.push_back(std::move(job));
    }
    return jobs;
}

/// One predictor's runs of a range of seeds, by scenario.
std::vector<fs::path> files_of(const LinkPlan& plan, const LinkRunFiles& files,
                               const LinkPredictor& predictor, const SeedRange& range) {
    std::vector<fs::path> paths;
    for (const BenchmarkScenario& entry : plan.benchmark.scenarios) {
        for (const std::uint32_t replication : replications(range))
            paths.push_back(files.file(entry, replication, predictor));
    }
    return paths;
}

LinkRuns read_runs(const LinkPlan& plan, const LinkRunFiles& files, const LinkPredictor& predictor) {
    LinkRuns runs;
    for (const fs::path& file : files_of(plan, files, predictor, plan.own_seeds())) {
        runs.test.push_back(read_link_run(file));
        runs.test_timing.push_back(read_link_timing(file));
    }
    for (const fs::path& file : files_of(plan, files, predictor, plan.benchmark.validation))
        runs.validation.push_back(read_link_run(file));
    return runs;
}

}  // namespace

std::string settings_text(const LinkPredictor& predictor) {
    std::string text;
    for (const auto& [name, value] : predictor.settings)
        text += fmt::format("{}={} ", name, value);
    return text;
}

std::string LinkPlan::opponent() const {
    if (!against.empty()) return against;
    for (const char* const name : opponents) {
        if (core::contains(predictors, name, &LinkPredictor::name)) return name;
    }
    return {};
}

std::vector<ComparedPair> LinkPlan::comparisons() const {
    std::vector<ComparedPair> present;
    const auto judged = [&](const std::string& name) {
        return core::contains(predictors, name, &LinkPredictor::name);
    };
    std::ranges::copy_if(benchmark.comparisons, std::back_inserter(present), [&](const ComparedPair& pair) {
        return judged(pair.predictor) && judged(pair.against);
    });
    return present;
}

LinkRunFiles::LinkRunFiles(const LinkPlan& plan, std::string worker_hash)
    : plan_(plan), worker_hash_(std::move(worker_hash)) {
    for (const BenchmarkScenario& entry : plan.benchmark.scenarios)
        scenario_hashes_[scenario::configuration_hash(entry.config)] = scenario::scenario_hash(entry.config);
}

const std::string& LinkRunFiles::hash_of(const scenario::ScenarioConfig& config) const {
    return scenario_hashes_.at(scenario::configuration_hash(config));
}

fs::path LinkRunFiles::scenario_folder(const scenario::ScenarioConfig& config) const {
    return plan_.folder / "scenarios" / fmt::format("{}-{}", config.name, hash_of(config).substr(0, 8));
}

fs::path LinkRunFiles::file(const BenchmarkScenario& entry, std::uint32_t replication,
                            const LinkPredictor& predictor) const {
    return plan_.folder / "runs" / entry.label / std::to_string(replication) /
           fmt::format("{}-{}{}", predictor.name, key(entry, predictor), link_run_extension);
}

std::string LinkRunFiles::key(const BenchmarkScenario& entry, const LinkPredictor& predictor) const {
    std::string content =
        fmt::format("{} {} {} ", worker_hash_, hash_of(entry.config), plan_.benchmark.study_seed);
    for (const std::string& failure : plan_.benchmark.failures)
        content += failure + " ";
    for (const Exits exits : plan_.benchmark.exits)
        content += fmt::format("{} ", core::name(exits));
    content += fmt::format("{} {} {} ", core::name(plan_.benchmark.candidates),
                           plan_.benchmark.links.link_radius_m, plan_.benchmark.links.automated_links);
    if (!entry.policy.empty()) content += fmt::format("policy {} ", entry.policy);
    content += (predictor.part.empty() ? predictor.name : predictor.part) + " " + settings_text(predictor);
    if (!predictor.model_file.empty()) content += core::content_hash(core::read_file(predictor.model_file));
    return core::content_hash(content).substr(0, 16);
}

std::vector<experiment::LinkJob> missing_runs(const LinkPlan& plan, const LinkRunFiles& files) {
    std::vector<experiment::LinkJob> missing;
    for (const BenchmarkScenario& entry : plan.benchmark.scenarios) {
        std::vector<experiment::LinkJob> jobs = missing_of(plan, files, entry);
        if (jobs.empty()) continue;
        const fs::path folder = files.scenario_folder(entry.config);
        core::make_folder(folder);
        core::remove_abandoned_parts(folder);
        scenario::store(entry.config, folder);
        scenario::build_network(entry.config, folder / "network");
        std::ranges::move(jobs, std::back_inserter(missing));
    }
    return missing;
}

LinkVerdict judge(const LinkPlan& plan, const LinkRunFiles& files) {
    const std::vector<std::size_t> runs_by_scenario(plan.benchmark.scenarios.size(), plan.own_seeds().count);
    LinkJudgement judgement(runs_by_scenario);
    LinkComparisons comparisons(runs_by_scenario, plan.comparisons(),
                                plan.benchmark.failures.size() * plan.benchmark.exits.size());
    core::Progress progress("judging", plan.predictors.size(), core::Progress::style_for_stderr());
    for (std::size_t i = 0; i < plan.predictors.size(); ++i) {
        const LinkRuns runs = read_runs(plan, files, plan.predictors[i]);
        judgement.add(runs);
        comparisons.add(runs);
        progress.update(i + 1, 0);
    }
    progress.finish();
    const std::string opponent = plan.opponent();
    return {judgement.results(), opponent.empty() ? std::vector<LinkGain>() : judgement.gains(opponent),
            comparisons.results()};
}

}  // namespace clearway::links
