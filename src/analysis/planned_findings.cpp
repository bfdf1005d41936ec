#include "analysis/planned_findings.hpp"

#include <algorithm>

namespace clearway::analysis {
namespace {

using experiment::TrafficModel;
using results::AnalysisPlan;
using results::Claim;

/// Mean of the first condition that `fits`; nothing if none does or its runs are missing.
template <class Fits>
std::optional<double> mean_of(const ScenarioSummary& scenario, const std::string& metric, const Fits& fits) {
    const auto found = std::ranges::find_if(scenario.conditions,
                                            [&](const ConditionSummary& one) { return fits(one.condition); });
    if (found == scenario.conditions.end() || !found->metric(metric).estimate) return std::nullopt;
    return found->metric(metric).estimate->mean;
}

/// The delay is what the baseline takes longer than an emergency vehicle alone on the road.
double margin_in(const ScenarioSummary& scenario, const AnalysisPlan& plan) {
    const auto baseline = mean_of(scenario, plan.metric, [](const experiment::ConditionSpec& one) {
        return !one.acts() && one.traffic_model != TrafficModel::free_flow;
    });
    const auto solo = mean_of(scenario, plan.metric, [](const experiment::ConditionSpec& one) {
        return one.traffic_model == TrafficModel::free_flow;
    });
    const double delay_s = baseline && solo ? std::max(0.0, *baseline - *solo) : 0.0;
    return std::max(plan.margin_s, plan.margin_share * delay_s);
}

PlannedFinding find(const results::PlannedComparison& comparison, const ScenarioSummary& scenario,
                    const AnalysisPlan& plan) {
    PlannedFinding finding;
    finding.comparison = comparison;
    finding.scenario = scenario.scenario;
    finding.margin_s = margin_in(scenario, plan);
    const ConditionSummary* const condition = scenario.find(comparison.condition);
    const ConditionSummary* const against = scenario.find(comparison.against);
    if (condition == nullptr || against == nullptr) return finding;
    const detail::Pairs pairs =
        detail::pairs_of(condition->metric(plan.metric).values, against->metric(plan.metric).values);
    finding.pairs = pairs.condition.size();
    finding.difference = estimate_difference(pairs.condition, pairs.baseline, 1.0 - plan.alpha);
    if (comparison.claim == Claim::difference) {
        finding.p = paired_t_p(pairs.condition, pairs.baseline);
    } else if (finding.margin_s > 0.0) {
        finding.p = paired_equivalence_p(pairs.condition, pairs.baseline, finding.margin_s);
    }
    return finding;
}

bool loses_more(const ScenarioSummary& scenario, const results::PlannedComparison& comparison) {
    const ConditionSummary* const condition = scenario.find(comparison.condition);
    const ConditionSummary* const against = scenario.find(comparison.against);
    return condition != nullptr && against != nullptr &&
           condition->emergency.lost() > against->emergency.lost();
}

Shown shown_by(const PlannedFinding& finding, const ScenarioSummary& scenario, const AnalysisPlan& plan,
               std::size_t replications) {
    if (finding.pairs < replications || !finding.difference) return Shown::incomplete;
    const bool claims = finding.holm_p && *finding.holm_p <= plan.alpha;
    const double mean = finding.difference->mean;
    if (finding.comparison.claim == Claim::difference) {
        if (!claims) return Shown::not_shown;
        if (mean > 0.0) return Shown::worse;
        return loses_more(scenario, finding.comparison) ? Shown::ruled_out : Shown::better;
    }
    if (loses_more(scenario, finding.comparison)) return Shown::ruled_out;
    const auto& interval = finding.difference->interval;
    const bool within = interval && -finding.margin_s < interval->low && interval->high < finding.margin_s;
    return claims && within ? Shown::equivalent : Shown::not_shown;
}

}  // namespace

std::vector<PlannedFinding> planned_findings(const Summary& summary) {
    if (!summary.manifest.plan) return {};
    const AnalysisPlan& plan = *summary.manifest.plan;
    std::vector<PlannedFinding> findings;
    std::vector<const ScenarioSummary*> scenarios;
    for (const results::PlannedComparison& comparison : plan.comparisons) {
        for (const ScenarioSummary& scenario : summary.scenarios) {
            if (!comparison.scenario.empty() && comparison.scenario != scenario.scenario) continue;
            findings.push_back(find(comparison, scenario, plan));
            scenarios.push_back(&scenario);
        }
    }
    std::vector<double> p_values;
    for (const PlannedFinding& finding : findings)
        p_values.push_back(finding.p.value_or(1.0));
    const std::vector<double> adjusted = holm(p_values);
    for (std::size_t at = 0; at < findings.size(); ++at) {
        if (findings[at].p) findings[at].holm_p = adjusted[at];
        findings[at].shown = shown_by(findings[at], *scenarios[at], plan, summary.manifest.replications);
    }
    return findings;
}

}  // namespace clearway::analysis
