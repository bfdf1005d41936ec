#include "loop/evaluate_links.hpp"

#include <algorithm>
#include <filesystem>
#include <span>

#include <fmt/format.h>

#include "core/files.hpp"
#include "experiment/link_order.hpp"
#include "links/link_evaluation.hpp"
#include "loop/detail/plain_run.hpp"
#include "loop/detail/work_folder.hpp"
#include "loop/unit_run.hpp"

namespace clearway::loop {
namespace {

std::unique_ptr<prediction::Predictor> make(const experiment::LinkPredictorOrder& order,
                                            const roads::Network& network, const graph::LinkRules& rules) {
    return prediction::make_predictor(
        order.name, {.network = network, .rules = rules, .model_file = order.model_file}, order.settings);
}

void add_trials(const experiment::LinkOrder& order, const roads::Network& network,
                const graph::LinkRules& rules, links::LinkEvaluator& evaluator) {
    const core::KeyedRandom random = detail::random_of(order);
    for (const std::string& exits : order.exits) {
        for (const std::string& failure : order.failures) {
            links::LinkTrial::Setup setup{
                .failure = failure,
                .exits = exits,
                .sensor = detail::sensor_of(failure, exits, random, {.network = network, .rules = rules}),
                .predictors = {}};
            for (const experiment::LinkPredictorOrder& predictor : order.predictors)
                setup.predictors.push_back(make(predictor, network, rules));
            evaluator.add(std::move(setup));
        }
    }
}

void check_scored(const experiment::LinkOrder& order, const links::LinkEvaluator& evaluator) {
    for (const links::LinkTrial& trial : evaluator.trials()) {
        if (trial.result(0).truth.reports > 0) continue;
        throw core::InputError(
            {order.scenario,
             "the run ended before a report was scored: no vehicle is on the road once the "
             "first emergency vehicle departs or the warm-up ends",
             "at least one report", "Give the scenario a longer window or horizon"});
    }
}

void write_results(const experiment::LinkOrder& order, const std::string& configuration_hash,
                   const links::LinkEvaluator& evaluator) {
    for (std::size_t number = 0; number < order.predictors.size(); ++number) {
        const experiment::LinkPredictorOrder& predictor = order.predictors[number];
        links::LinkRun run{.scenario = order.scenario,
                           .configuration_hash = configuration_hash,
                           .study_seed = order.study_seed,
                           .replication = order.replication,
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

core::ExitCode evaluate_links(const std::filesystem::path& order_file) {
    const experiment::LinkOrder order = experiment::read_link_order(order_file);
    const detail::WorkFolder work(order.work_folder);
    UnitRun run(detail::unit_of(order), work.path(), work.path());
    const graph::LinkRules rules = detail::link_rules();
    links::LinkEvaluator evaluator(run.network(), rules, run.first_emergency());
    add_trials(order, run.network(), rules, evaluator);
    run.record(detail::plain_traffic("links"), evaluator);
    check_scored(order, evaluator);
    write_results(order, run.scenario_hash(), evaluator);
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
