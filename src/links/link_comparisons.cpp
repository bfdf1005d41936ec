#include "links/link_comparisons.hpp"

#include <algorithm>

#include "links/detail/link_cases.hpp"
#include "links/detail/link_draws.hpp"

namespace clearway::links {
namespace {

constexpr std::size_t least_resamples = 10000;
constexpr std::size_t resamples_per_test = 500;
constexpr std::size_t measures_per_case = 2;  // AP and F1

LinkComparison::Difference difference(const std::optional<double>& one, const std::optional<double>& other,
                                      std::vector<double> draws, const std::vector<double>& other_draws,
                                      const analysis::RunResampling& resampling) {
    LinkComparison::Difference result;
    if (!one || !other) return result;
    for (std::size_t i = 0; i < draws.size(); ++i)
        draws[i] -= other_draws[i];
    result.difference = {*one - *other, resampling.interval(draws)};
    result.p = resampling.p(draws);
    return result;
}

/// Adjusts all p-values together. A test without a p-value counts as one that found nothing.
void adjust(std::vector<LinkComparison>& comparisons) {
    std::vector<LinkComparison::Difference*> tests;
    std::vector<double> p_values;
    for (LinkComparison& comparison : comparisons) {
        for (LinkComparison::Difference* const test : {&comparison.ap, &comparison.f1}) {
            tests.push_back(test);
            p_values.push_back(test->p.value_or(1.0));
        }
    }
    const std::vector<double> adjusted = analysis::holm(p_values);
    for (std::size_t i = 0; i < tests.size(); ++i) {
        if (tests[i]->p) tests[i]->holm_p = adjusted[i];
    }
}

}  // namespace

LinkComparisons::LinkComparisons(const std::vector<std::size_t>& runs_by_scenario,
                                 std::vector<ComparedPair> pairs, std::size_t cases)
    : pairs_(std::move(pairs)) {
    if (pairs_.empty()) return;
    const std::size_t tests = pairs_.size() * cases * measures_per_case;
    resampling_.emplace(
        runs_by_scenario,
        analysis::RunResampling::Config{.resamples = std::max(least_resamples, resamples_per_test * tests)});
}

void LinkComparisons::add(const LinkRuns& runs) {
    const std::string& predictor = runs.test.front().predictor;
    const bool wanted = std::ranges::any_of(pairs_, [&](const ComparedPair& pair) {
        return pair.predictor == predictor || pair.against == predictor;
    });
    if (!wanted) return;
    for (std::size_t number = 0; number < runs.test.front().cases.size(); ++number) {
        const std::vector<LinkSummary> summaries =
            detail::summaries_of(detail::cases_of(runs.test, number), LinkSubset::all);
        detail::DrawnMeasures drawn =
            detail::draw_measures(summaries, detail::threshold_of(runs.validation, number), *resampling_);
        const LinkCase& one = runs.test.front().cases[number];
        measures_[predictor].push_back({one.failure, one.exits, drawn.ap.value, drawn.f1.value,
                                        std::move(drawn.ap.draws), std::move(drawn.f1.draws)});
    }
}

std::vector<LinkComparison> LinkComparisons::results() const {
    std::vector<LinkComparison> comparisons;
    for (const ComparedPair& pair : pairs_) {
        const auto one = measures_.find(pair.predictor);
        const auto other = measures_.find(pair.against);
        if (one == measures_.end() || other == measures_.end()) continue;
        for (std::size_t number = 0; number < one->second.size(); ++number)
            comparisons.push_back(compared(pair, one->second[number], other->second[number]));
    }
    adjust(comparisons);
    return comparisons;
}

LinkComparison LinkComparisons::compared(const ComparedPair& pair, const Measures& one,
                                         const Measures& other) const {
    return {.failure = one.failure,
            .exits = one.exits,
            .pair = pair,
            .ap = difference(one.ap, other.ap, one.ap_draws, other.ap_draws, *resampling_),
            .f1 = difference(one.f1, other.f1, one.f1_draws, other.f1_draws, *resampling_)};
}

}  // namespace clearway::links
