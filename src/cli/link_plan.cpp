#include "cli/link_plan.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/names.hpp"
#include "cli/programs.hpp"
#include "core/files.hpp"
#include "core/progress.hpp"
#include "experiment/link_job.hpp"
#include "links/link_judgement.hpp"
#include "links/link_run.hpp"
#include "prediction/predictor.hpp"
#include "scenario/network.hpp"
#include "sensing/failure_config.hpp"

namespace clearway::cli {
namespace {

namespace fs = std::filesystem;

/// Predictors that do not learn, the strongest first: the first one present is the opponent.
constexpr std::array opponents = {"route_rule", "kalman", "dead_reckoning", "last_seen", "none"};

/// A scenario's place in the folder.
struct Place {
    fs::path folder;
    std::string configuration_hash;
};

std::string settings_text(const LinkPredictor& predictor) {
    std::string text;
    for (const auto& [name, value] : predictor.settings)
        text += fmt::format("{}={} ", name, value);
    return text;
}

/// Identity of the program that does the runs.
std::string worker_hash() {
    const std::string program = sister_program("clearway-run");
    if (!fs::exists(program))
        throw core::EnvironmentError(
            fmt::format("{} is missing. `clearway doctor` shows what else is", program));
    return core::content_hash(core::read_file(program));
}

/// Where the runs of a plan are.
class RunFiles {
  public:
    explicit RunFiles(const LinkPlan& plan) : plan_(plan), program_hash_(worker_hash()) {
        for (const scenario::ScenarioConfig& config : plan.benchmark.scenarios)
            scenario_hashes_[scenario::configuration_hash(config)] = scenario::scenario_hash(config);
    }

    Place place_of(const scenario::ScenarioConfig& config) const {
        const std::string& hash = hash_of(config);
        return {plan_.folder / "scenarios" / fmt::format("{}-{}", config.name, hash.substr(0, 8)), hash};
    }

    fs::path file(const scenario::ScenarioConfig& config, std::uint32_t replication,
                  const LinkPredictor& predictor) const {
        return plan_.folder / "runs" / config.name / std::to_string(replication) /
               fmt::format("{}-{}{}", predictor.name, key(config, predictor), links::link_run_extension);
    }

  private:
    /// Files are read once.
    const std::string& hash_of(const scenario::ScenarioConfig& config) const {
        return scenario_hashes_.at(scenario::configuration_hash(config));
    }
    std::string key(const scenario::ScenarioConfig& config, const LinkPredictor& predictor) const {
        std::string content =
            fmt::format("{} {} {} ", program_hash_, hash_of(config), plan_.benchmark.study_seed);
        for (const std::string& failure : plan_.benchmark.failures)
            content += failure + " ";
        for (const std::string& exits : plan_.benchmark.exits)
            content += exits + " ";
        content += predictor.name + " " + settings_text(predictor);
        if (!predictor.model_file.empty())
            content += core::content_hash(core::read_file(predictor.model_file));
        return core::content_hash(content).substr(0, 16);
    }

    const LinkPlan& plan_;
    std::string program_hash_;
    std::map<std::string, std::string> scenario_hashes_;  ///< By that of the configuration alone.
};

std::vector<std::uint32_t> replications(const links::SeedRange& range) {
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

std::vector<experiment::JudgedPredictor> missing(const LinkPlan& plan, const RunFiles& files,
                                                 const scenario::ScenarioConfig& config,
                                                 std::uint32_t replication) {
    std::vector<experiment::JudgedPredictor> orders;
    for (const LinkPredictor& predictor : plan.predictors) {
        const fs::path file = files.file(config, replication, predictor);
        if (fs::exists(file)) continue;
        const fs::path model = predictor.model_file.empty() ? fs::path() : fs::absolute(predictor.model_file);
        orders.push_back({predictor.name, model.string(), predictor.settings, file});
    }
    return orders;
}

/// The jobs of a scenario, which is stored and built when there are any.
void add_jobs(const LinkPlan& plan, const RunFiles& files, const scenario::ScenarioConfig& config,
              std::vector<WorkerJob>& work) {
    const Place place = files.place_of(config);
    bool built = false;
    for (const std::uint32_t replication : replications(plan)) {
        experiment::LinkJob job;
        job.predictors = missing(plan, files, config, replication);
        if (job.predictors.empty()) continue;
        if (!built) {
            core::make_folder(place.folder);
            scenario::store(config, place.folder);
            scenario::build_network(config, place.folder / "network");
            built = true;
        }
        const std::string name = fmt::format("{}-{}-{}", config.name, replication, ::getpid());
        job.scenario = config.name;
        job.scenario_file = place.folder / "scenario.toml";
        job.network_folder = place.folder / "network";
        job.study_seed = plan.benchmark.study_seed;
        job.replication = replication;
        job.work_folder = plan.folder / "work" / name;
        job.failures = plan.benchmark.failures;
        job.exits = plan.benchmark.exits;
        work.push_back({.label = fmt::format("{} replication {}", config.name, replication),
                        .job = job,
                        .file = plan.folder / "jobs" / (name + ".json"),
                        .log = plan.folder / "jobs" / (name + ".log"),
                        .work = job.work_folder});
    }
}

/// Reads one predictor's runs of some replications, scenario by scenario.
// NOLINTNEXTLINE(readability-function-size): whose runs, which, and two lists to fill
void read_runs(const LinkPlan& plan, const RunFiles& files, const LinkPredictor& predictor,
               const links::SeedRange& range, std::vector<links::LinkRun>& runs,
               std::vector<links::LinkTiming>* timings) {
    for (const scenario::ScenarioConfig& config : plan.benchmark.scenarios) {
        for (const std::uint32_t replication : replications(range)) {
            const fs::path file = files.file(config, replication, predictor);
            runs.push_back(links::read_link_run(file));
            if (timings != nullptr) timings->push_back(links::read_link_timing(file));
        }
    }
}

std::string opponent_of(const LinkPlan& plan) {
    if (!plan.against.empty()) return plan.against;
    for (const char* const name : opponents) {
        if (std::ranges::find(plan.predictors, name, &LinkPredictor::name) != plan.predictors.end())
            return name;
    }
    return {};
}

std::string range_text(const links::SeedRange& range) {
    return fmt::format("{} to {}", range.first, range.first + range.count - 1);
}

report::LinkFacts described(const LinkPlan& plan) {
    const links::LinkBenchmark& benchmark = plan.benchmark;
    const links::SeedRange& own = plan.split == LinkSplit::test ? benchmark.test : benchmark.validation;
    report::LinkFacts facts;
    facts.title = benchmark.name;
    facts.split = plan.split == LinkSplit::test ? "test" : "validation";
    facts.study_seed = benchmark.study_seed;
    facts.seeds = fmt::format("study seed {}, replications {}; thresholds of F1 chosen on {}",
                              benchmark.study_seed, range_text(own), range_text(benchmark.validation));
    facts.failures = benchmark.failures;
    facts.exits = benchmark.exits;
    facts.against = opponent_of(plan);
    for (const scenario::ScenarioConfig& config : benchmark.scenarios)
        facts.scenarios.push_back(config.name);
    const study::Versions versions = installed_versions();
    facts.provenance = {{"Clearway", versions.clearway}, {"SUMO", versions.sumo}};
    for (const scenario::ScenarioConfig& config : benchmark.scenarios) {
        facts.provenance.emplace_back("Configuration of " + config.name,
                                      scenario::configuration_hash(config));
    }
    for (const LinkPredictor& predictor : plan.predictors) {
        facts.predictors.push_back(predictor.name);
        const std::string settings = settings_text(predictor);
        if (!settings.empty()) facts.provenance.emplace_back("Settings of " + predictor.name, settings);
        if (!predictor.model_file.empty())
            facts.provenance.emplace_back("Model of " + predictor.name, predictor.model_file);
    }
    return facts;
}

}  // namespace

void check(const LinkPlan& plan) {
    std::vector<core::Problem> problems;
    const auto check_name = [&](const std::string& where, const std::string& name,
                                const std::vector<std::string>& known) {
        if (std::ranges::find(known, name) == known.end())
            problems.push_back(unknown_name(where, name, known));
    };
    for (const std::string& failure : plan.benchmark.failures)
        check_failure("--failure", failure, problems);
    for (const std::string& exits : plan.benchmark.exits)
        check_name("exits", exits, {"known", "unknown"});
    std::vector<std::string> present;
    for (const LinkPredictor& predictor : plan.predictors) {
        check_name("--predictor", predictor.name, prediction::predictor_names());
        present.push_back(predictor.name);
        prediction::check_settings(predictor.name, predictor.settings, "--set " + predictor.name, problems);
        if (!predictor.model_file.empty() && !fs::is_regular_file(predictor.model_file)) {
            problems.push_back({"--model " + predictor.name,
                                fmt::format("{} is no file", predictor.model_file),
                                "a .weights file of clearway train", ""});
        } else if (!predictor.model_file.empty()) {
            prediction::check_model(predictor.name, predictor.model_file);
        }
    }
    if (!plan.against.empty()) check_name("--against", plan.against, present);
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

core::ExitCode complete_runs(const LinkPlan& plan) {
    const RunFiles files(plan);
    std::vector<WorkerJob> work;
    for (const scenario::ScenarioConfig& config : plan.benchmark.scenarios)
        add_jobs(plan, files, config, work);
    if (work.empty()) return core::ExitCode::ok;
    return work_on(work, plan.jobs, "runs").exit_code;
}

report::LinkFacts judge(const LinkPlan& plan) {
    const RunFiles files(plan);
    const links::LinkBenchmark& benchmark = plan.benchmark;
    const links::SeedRange& own = plan.split == LinkSplit::test ? benchmark.test : benchmark.validation;
    links::LinkJudgement judgement(
        std::vector<std::size_t>(benchmark.scenarios.size(), std::size_t{own.count}));
    core::Progress progress("judging", plan.predictors.size(), core::Progress::style_for_stderr());
    for (std::size_t i = 0; i < plan.predictors.size(); ++i) {
        links::LinkRuns runs;
        read_runs(plan, files, plan.predictors[i], own, runs.test, &runs.test_timing);
        read_runs(plan, files, plan.predictors[i], benchmark.validation, runs.validation, nullptr);
        judgement.add(runs);
        progress.update(i + 1, 0);
    }
    progress.finish();
    report::LinkFacts facts = described(plan);
    facts.results = judgement.results();
    if (!facts.against.empty()) facts.gains = judgement.gains(facts.against);
    return facts;
}

}  // namespace clearway::cli
