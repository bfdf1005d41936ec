#include <algorithm>

#include "analysis/detail/condition_summary.hpp"
#include "analysis/summary.hpp"
#include "core/error.hpp"

namespace clearway::analysis {
namespace {

[[noreturn]] void refuse(const results::Results& baselines, const std::string& what) {
    throw core::InputError({baselines.manifest.study, "cannot adjust the comparison: " + what,
                            "the baselines of the same study, with at least as many replications",
                            "Make them with clearway study FILE --baselines N"});
}

/// Refuses baselines that are not of the same distribution.
void require_same(const results::Results& baselines, const Summary& summary, const ScenarioSummary& scenario,
                  const std::string& baseline) {
    const auto entry_of = [&](const results::Manifest& manifest) {
        return std::ranges::find(manifest.scenarios, scenario.scenario, &results::ScenarioEntry::name);
    };
    const auto there = entry_of(baselines.manifest);
    if (there == baselines.manifest.scenarios.end() ||
        there->configuration_hash != entry_of(summary.manifest)->configuration_hash)
        refuse(baselines, "it lacks scenario " + scenario.scenario + ", or has another one of that name");
    const auto& conditions = baselines.manifest.conditions;
    const auto same = std::ranges::find(conditions, baseline, &experiment::ConditionSpec::name);
    if (same == conditions.end() || !condition_differences(*same, scenario.find(baseline)->condition).empty())
        refuse(baselines, "it lacks condition " + baseline + ", or has another one of that name");
}

/// Of complete runs; none if no vehicle arrived in one: the rest would leave out the worst.
std::vector<double> losses_of(const detail::Runs& runs) {
    std::vector<double> losses_s;
    for (const results::RunRecord* run : runs) {
        if (run == nullptr) continue;
        if (!run->metrics.emergency_time_loss_s) return {};
        losses_s.push_back(*run->metrics.emergency_time_loss_s);
    }
    return losses_s;
}

/// Differences of the replications that have all of it, with their baseline's loss.
MaybeEstimate adjusted(const ConditionSummary& condition, const ConditionSummary& baseline,
                       const std::vector<double>& losses_s, double level) {
    const Values& with = condition.metric(primary_metric).values;
    const Values& without = baseline.metric(primary_metric).values;
    const Values& lost = baseline.metric("emergency_time_loss_s").values;
    std::vector<double> differences_s;
    std::vector<double> lost_s;
    for (std::size_t row = 0; row < std::min(with.size(), without.size()); ++row) {
        if (!with[row] || !without[row]) continue;
        if (!lost[row]) return std::nullopt;  // likewise
        differences_s.push_back(*with[row] - *without[row]);
        lost_s.push_back(*lost[row]);
    }
    if (losses_s.size() < differences_s.size()) return std::nullopt;
    return estimate_adjusted(differences_s, lost_s, losses_s, level);
}

}  // namespace

void adjust_by(const results::Results& baselines, Summary& summary) {
    const results::Manifest& manifest = baselines.manifest;
    if (manifest.study_seed != summary.manifest.study_seed) refuse(baselines, "it has another seed");
    if (manifest.replications < summary.manifest.replications) refuse(baselines, "it has fewer replications");
    if (manifest.clearway_build != summary.manifest.clearway_build)
        summary.builds.emplace(summary.manifest.clearway_build, manifest.clearway_build);
    const detail::Index index(baselines);
    for (const ScenarioSummary& scenario : summary.scenarios) {
        for (const ConditionSummary& condition : scenario.conditions) {
            if (condition.baseline.empty()) continue;
            require_same(baselines, summary, scenario, condition.baseline);
            const std::vector<double> losses_s = losses_of(index.runs(scenario.scenario, condition.baseline));
            const MaybeEstimate found =
                adjusted(condition, *scenario.find(condition.baseline), losses_s, summary.level);
            const MaybeEstimate& plain = condition.metric(primary_metric).comparison->difference;
            AdjustedDifference& one = summary.adjusted.emplace_back(
                AdjustedDifference{scenario.scenario, condition.condition.name, {}, losses_s.size()});
            if (!found || !plain || !(found->interval->half_width() > 0.0)) continue;
            one.difference = found;
            one.worth = required_replications(plain->deviation, found->interval->half_width(), summary.level);
        }
    }
}

}  // namespace clearway::analysis
