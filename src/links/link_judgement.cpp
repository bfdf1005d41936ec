#include "links/link_judgement.hpp"

#include <cassert>

#include "links/detail/dark_draws.hpp"
#include "links/detail/link_cases.hpp"
#include "links/detail/link_draws.hpp"

namespace clearway::links {
namespace {

using detail::cases_of;
using detail::Drawn;
using detail::summaries_of;

LinkMeasures measures_from(const detail::DrawnMeasures& drawn, const analysis::RunResampling& resampling) {
    return {drawn.sum.pairs(),
            drawn.sum.true_links(),
            drawn.ap.measured(resampling),
            drawn.auc.measured(resampling),
            drawn.f1.measured(resampling),
            drawn.log_loss.measured(resampling),
            drawn.ece.measured(resampling),
            drawn.brier.measured(resampling)};
}

LinkEndToEnd end_to_end(const std::vector<const LinkCase*>& cases,
                        const analysis::RunResampling& resampling) {
    LinkEndToEnd result;
    for (const LinkCase* const one : cases) {
        add_counts(result.truth, one->truth);
        add_counts(result.belief, one->belief);
    }
    const auto measured = [&](auto above, auto below) {
        return detail::draw_ratio(detail::column_of(cases, above), detail::column_of(cases, below),
                                  resampling)
            .measured(resampling);
    };
    const auto listed_true = [](const LinkCase* one) { return one->belief.listed_true; };
    const auto listed = [](const LinkCase* one) {
        return one->belief.listed_true + one->belief.listed_false;
    };
    const auto all = [](const LinkCase* one) { return one->truth.true_links; };
    result.precision = measured(listed_true, listed);
    result.recall = measured(listed_true, all);
    result.f1 = measured([&](const LinkCase* one) { return 2 * listed_true(one); },
                         [&](const LinkCase* one) { return listed(one) + all(one); });
    result.policy_recall = measured([](const LinkCase* one) { return one->belief.policy_found; },
                                    [](const LinkCase* one) { return one->truth.policy_links; });
    return result;
}

void add_timing(std::span<const LinkTiming> timings, std::size_t number, LinkResult& result) {
    LinkTiming::Case sum;
    for (const LinkTiming& timing : timings) {
        sum.reports += timing.cases[number].reports;
        sum.vehicles += timing.cases[number].vehicles;
        sum.predict_s += timing.cases[number].predict_s;
    }
    if (sum.reports == 0) return;
    result.report_us = 1e6 * sum.predict_s / static_cast<double>(sum.reports);
    result.report_vehicles = static_cast<double>(sum.vehicles) / static_cast<double>(sum.reports);
}

LinkResult result_for(const LinkRun& run, std::size_t number, double threshold) {
    LinkResult result;
    result.failure = run.cases[number].failure;
    result.exits = run.cases[number].exits;
    result.predictor = run.predictor;
    result.threshold = threshold;
    return result;
}

/// 1 - (1 - one) / (1 - other), for the values and for every draw.
Drawn reduction(const Drawn& one, const Drawn& other) {
    const auto formula = [](double better, double worse) { return 1.0 - (1.0 - better) / (1.0 - worse); };
    Drawn drawn;
    if (one.value && other.value && *other.value < 1.0) drawn.value = formula(*one.value, *other.value);
    for (std::size_t i = 0; i < one.draws.size(); ++i)
        drawn.draws.push_back(formula(one.draws[i], other.draws[i]));
    return drawn;
}

Drawn difference(const Drawn& one, const Drawn& other) {
    Drawn drawn;
    if (one.value && other.value) drawn.value = *one.value - *other.value;
    for (std::size_t i = 0; i < one.draws.size(); ++i)
        drawn.draws.push_back(one.draws[i] - other.draws[i]);
    return drawn;
}

}  // namespace

std::optional<double> LinkEndToEnd::ghosts_per_report() const {
    if (truth.reports == 0) return std::nullopt;
    return static_cast<double>(belief.ghosts) / static_cast<double>(truth.reports);
}

LinkJudgement::LinkJudgement(const std::vector<std::size_t>& runs_by_scenario)
    : runs_by_scenario_(runs_by_scenario), pooled_(runs_by_scenario) {}

void LinkJudgement::add(const LinkRuns& runs) {
    assert(runs.test.size() == pooled_.runs() && !runs.test.empty());
    const std::size_t cases = runs.test.front().cases.size();
    std::vector<double> thresholds;
    for (std::size_t number = 0; number < cases; ++number) {
        thresholds.push_back(detail::threshold_of(runs.validation, number));
        add_pooled(runs, number, thresholds.back());
    }
    if (runs_by_scenario_.size() < 2) return;
    for (std::size_t scenario = 0; scenario < runs_by_scenario_.size(); ++scenario) {
        for (std::size_t number = 0; number < cases; ++number)
            add_scenario(runs, number, scenario, thresholds[number]);
    }
}

void LinkJudgement::add_pooled(const LinkRuns& runs, std::size_t number, double threshold) {
    const std::vector<const LinkCase*> cases = cases_of(runs.test, number);
    LinkResult result = result_for(runs.test.front(), number, threshold);
    if (runs_by_scenario_.size() == 1) result.scenario = runs.test.front().scenario;
    pooled_cases_.push_back({results_.size(), measure(cases, pooled_, result)});
    for (const LinkCase* const one : cases)
        result.scores.add(one->scores);
    add_timing(runs.test_timing, number, result);
    results_.push_back(std::move(result));
}

void LinkJudgement::add_scenario(const LinkRuns& runs, std::size_t number, std::size_t scenario,
                                 double threshold) {
    std::size_t first = 0;
    for (std::size_t before = 0; before < scenario; ++before)
        first += runs_by_scenario_[before];
    const std::size_t count = runs_by_scenario_[scenario];
    const analysis::RunResampling resampling({count});
    const auto own = std::span(runs.test).subspan(first, count);
    const std::vector<const LinkCase*> cases = cases_of(own, number);
    LinkResult result = result_for(own.front(), number, threshold);
    result.scenario = own.front().scenario;
    measure(cases, resampling, result);
    add_timing(std::span(runs.test_timing).subspan(first, count), number, result);
    results_.push_back(std::move(result));
}

LinkJudgement::Draws LinkJudgement::measure(const std::vector<const LinkCase*>& cases,
                                            const analysis::RunResampling& resampling, LinkResult& result) {
    Draws draws;
    for (const LinkSubset subset : link_subsets) {
        const std::vector<LinkSummary> runs = summaries_of(cases, subset);
        const detail::DrawnMeasures drawn = detail::draw_measures(runs, result.threshold, resampling);
        result.subsets[static_cast<std::size_t>(subset)] = measures_from(drawn, resampling);
        if (subset != LinkSubset::all) continue;
        result.failed = detail::failed_measures(cases, runs, drawn, result.threshold, resampling);
        draws = {drawn.ap.draws, drawn.f1.draws};
    }
    result.dark = detail::dark_measures(cases, resampling);
    result.end_to_end = end_to_end(cases, resampling);
    return draws;
}

std::vector<LinkGain> LinkJudgement::gains(const std::string& against) const {
    std::vector<LinkGain> gains;
    for (const PooledCase& one : pooled_cases_) {
        const LinkResult& result = results_[one.result];
        if (result.predictor == against) continue;
        for (const PooledCase& other : pooled_cases_) {
            const LinkResult& opponent = results_[other.result];
            if (opponent.predictor == against && opponent.failure == result.failure &&
                opponent.exits == result.exits)
                gains.push_back(gain(one, other));
        }
    }
    return gains;
}

LinkGain LinkJudgement::gain(const PooledCase& one, const PooledCase& other) const {
    const LinkResult& result = results_[one.result];
    const LinkResult& opponent = results_[other.result];
    const LinkMeasures& own = result.of(LinkSubset::all);
    const LinkMeasures& theirs = opponent.of(LinkSubset::all);
    const Drawn ap{own.ap.value, one.draws.ap};
    const Drawn other_ap{theirs.ap.value, other.draws.ap};
    const Drawn f1{own.f1.value, one.draws.f1};
    const Drawn other_f1{theirs.f1.value, other.draws.f1};
    return {.failure = result.failure,
            .exits = result.exits,
            .predictor = result.predictor,
            .against = opponent.predictor,
            .ap_difference = difference(ap, other_ap).measured(pooled_),
            .ap_error_reduction = reduction(ap, other_ap).measured(pooled_),
            .f1_error_reduction = reduction(f1, other_f1).measured(pooled_)};
}

}  // namespace clearway::links
