#include "core/files.hpp"
#include "core/temporary_folder.hpp"
#include "experiment/link_job.hpp"
#include "links/link_evaluation.hpp"
#include "loop/detail/plain_run.hpp"
#include "loop/jobs.hpp"
#include "loop/unit_run.hpp"

namespace clearway::loop {
namespace {

std::unique_ptr<prediction::Predictor> make(const experiment::JudgedPredictor& job,
                                            const roads::Network& network, const graph::LinkRules& rules) {
    return prediction::make_predictor(job.part.empty() ? job.name : job.part,
                                      {.network = network, .rules = rules, .model_file = job.model_file},
                                      job.settings);
}

void add_trials(const experiment::LinkJob& job, const roads::Network& network, const graph::LinkRules& rules,
                links::LinkEvaluator& evaluator) {
    const core::KeyedRandom random = detail::random_of(job);
    for (const failures::Exits exits : job.exits) {
        for (const std::string& failure : job.failures) {
            links::LinkTrial::Setup setup{
                .failure = failure,
                .exits = exits,
                .sensor = detail::sensor_of(failure, exits, random, {.network = network, .rules = rules}),
                .predictors = {}};
            for (const experiment::JudgedPredictor& predictor : job.predictors)
                setup.predictors.push_back(make(predictor, network, rules));
            evaluator.add(std::move(setup));
        }
    }
}

/// The traffic, in which a policy may act on what perfect sensors see. Predictors only watch. Yellow and red
/// are those with which the first benchmark with a policy was frozen.
experiment::ConditionSpec traffic_of(const experiment::LinkJob& job) {
    experiment::ConditionSpec condition = detail::plain_traffic("links");
    if (!job.policy.empty()) {
        condition.policies = {job.policy};
        condition.settings = {{"actuation.clearance", "fixed"}};
    }
    return condition;
}

void check_scored(const experiment::LinkJob& job, const links::LinkEvaluator& evaluator) {
    for (const links::LinkTrial& trial : evaluator.trials()) {
        if (trial.result(0).truth.reports > 0) continue;
        throw core::InputError(
            {job.scenario,
             "the run ended before a report was scored: no vehicle is on the road once the "
             "first emergency vehicle departs or the warm-up ends",
             "at least one report", "Give the scenario a longer window or horizon"});
    }
}

void write_results(const experiment::LinkJob& job, const std::string& configuration_hash,
                   const links::LinkEvaluator& evaluator) {
    for (std::size_t number = 0; number < job.predictors.size(); ++number) {
        const experiment::JudgedPredictor& predictor = job.predictors[number];
        links::LinkRun run{.scenario = job.scenario,
                           .configuration_hash = configuration_hash,
                           .study_seed = job.study_seed,
                           .replication = job.replication,
                           .predictor = predictor.name,
                           .cases = {}};
        links::LinkTiming timing;
        for (const links::LinkTrial& trial : evaluator.trials()) {
            run.cases.push_back(trial.result(number));
            timing.cases.push_back(trial.timing(number));
        }
        core::make_folder(predictor.output.parent_path());
        links::write_link_run(predictor.output, run, timing);
    }
}

}  // namespace

core::ExitCode evaluate_links(const experiment::LinkJob& job) {
    const core::TemporaryFolder work(job.work_folder);
    UnitRun run(job, work.path());
    const graph::LinkRules rules = job.rules();
    links::LinkEvaluator evaluator(run.network(), rules, run.first_emergency());
    add_trials(job, run.network(), rules, evaluator);
    run.record(traffic_of(job), evaluator);
    check_scored(job, evaluator);
    write_results(job, run.scenario_hash(), evaluator);
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
