#include "analysis/replications.hpp"

namespace clearway::analysis {
namespace {

const MaybeEstimate& difference_of(const MetricSummary& metric) {
    static const MaybeEstimate none;
    return metric.comparison ? metric.comparison->difference : none;
}

/// The condition whose estimate, from `estimate_of`, needs most replications.
template <class EstimateOf>
std::optional<Precision> widest_by(const Summary& summary, const std::string& metric, double half_width,
                                   EstimateOf&& estimate_of) {
    std::optional<Precision> found;
    for (const ScenarioSummary& scenario : summary.scenarios) {
        for (const ConditionSummary& condition : scenario.conditions) {
            const MetricSummary& values = condition.metric(metric);
            const MaybeEstimate& estimate = estimate_of(values);
            if (!estimate || !estimate->interval) continue;
            const std::size_t required =
                required_replications(estimate->deviation, half_width, summary.level);
            if (found && required <= found->required) continue;
            found = Precision{scenario.scenario,
                              condition.condition.name,
                              estimate->interval->half_width(),
                              estimate->n,
                              required,
                              values.values.size() - estimate->n};
        }
    }
    return found;
}

}  // namespace

std::optional<Precision> widest(const Summary& summary, const std::string& metric, double half_width) {
    const auto compared = widest_by(summary, metric, half_width, difference_of);
    if (compared) return compared;
    return widest_by(summary, metric, half_width,
                     [](const MetricSummary& values) -> const MaybeEstimate& { return values.estimate; });
}

}  // namespace clearway::analysis
