#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bootstrap.hpp"
#include "analysis/estimate.hpp"
#include "analysis/objections.hpp"
#include "analysis/traffic.hpp"
#include "results/store.hpp"

namespace clearway::analysis {

/// What a metric's values are, which decides its interval.
enum class MetricKind : std::uint8_t {
    quantity,  ///< Durations, shares: `estimate_not_negative`.
    count,     ///< 0, 1, 2, ...: `estimate_count`, never below 0.
};

/// A metric as tables show it. All come from the field table of metrics::RunMetrics.
struct MetricInfo {
    std::string name;
    std::string unit;
    std::string doc;
    MetricKind kind = MetricKind::quantity;
};

/// One value for each replication; nothing where there is none.
using Values = std::vector<std::optional<double>>;

/// Mean of the values that there are, with the interval of the metric's kind.
std::optional<Estimate> estimate_values(const Values& values, MetricKind kind, double level = usual_level);
/// Mean of the paired differences of the replications where both have a value.
std::optional<Estimate> estimate_paired(const Values& condition, const Values& baseline, MetricKind kind,
                                        double level = usual_level);
/// All metrics of a run that are numbers, in the order of their field table.
std::vector<MetricInfo> all_metrics();
/// Value of a metric by name; nothing where the run has none. Throws std::out_of_range for an unknown name.
std::optional<double> metric_value(const metrics::RunMetrics& metrics, const std::string& name);

/// The metric that verdicts, headlines, curves and gates speak of: nobody is left out of it.
inline constexpr const char* primary_metric = "emergency_restricted_travel_time_s";

/// A condition against its baseline, in one metric, paired by replication. For metrics of emergency vehicles
/// that are means over those that arrived (`emergency_travel_time_s`, `emergency_time_loss_s`), a
/// replication's pair is the means over the vehicles that arrived in both conditions; the vehicles left out
/// are counted.
struct Comparison {
    std::size_t complete_pairs = 0;
    /// Replications that lack a value in at least one of the two conditions: failed, missing, nobody to
    /// average over.
    std::size_t incomplete_pairs = 0;
    /// Emergency vehicles of complete pairs that arrived in only one condition or in none.
    std::size_t vehicles_left_out = 0;
    std::vector<double> condition_values;     ///< Of complete pairs, in the order of the replications.
    std::vector<double> baseline_values;      ///< Of the same pairs.
    std::optional<Estimate> difference;       ///< Condition - baseline, in the metric's unit.
    std::optional<Estimate> relative;         ///< As a share of the baseline's mean.
    std::optional<Interval> bootstrap;        ///< BCa interval of the mean difference; not for counts.
    std::optional<double> median;             ///< Of the paired differences.
    std::optional<Interval> median_interval;  ///< From order statistics.
    std::optional<double> effect_size;        ///< Cohen's d for pairs, d_z.
    std::optional<double> t_p;                ///< Not for counts, which are far from normal.
    std::optional<double> wilcoxon_p;
    /// Adjusted over all comparisons of a scenario in this metric: `t_p`, of counts `wilcoxon_p`.
    std::optional<double> holm_p;
};

/// One cell of a table: a metric in a condition of a scenario.
struct MetricSummary {
    MetricInfo metric;
    Values values;                     ///< By replication.
    std::optional<Estimate> estimate;  ///< Over the replications that have a value.
    std::optional<double> median;
    std::optional<Interval> median_interval;
    std::optional<double> percentile_95;
    std::optional<Interval> percentile_95_interval;  ///< Takes 72 replications.
    std::optional<Comparison> comparison;  ///< Nothing for the baseline itself and for the solo condition.
};

/// Travel times of all emergency vehicles of a condition, those that did not arrive ranked last.
struct TravelTimeTail {
    PooledQuantile median;
    PooledQuantile percentile_95;
};

struct ConditionSummary {
    experiment::ConditionSpec condition;
    std::string baseline;  ///< Condition it is compared with; empty for baselines and solo.
    std::size_t complete_runs = 0;
    std::size_t failed_runs = 0;
    std::size_t missing_runs = 0;
    /// Complete runs with emergency vehicles but without a restricted travel time: an older version made them
    /// and did not note the horizon.
    std::size_t runs_without_horizon = 0;
    OutcomeCounts emergency;
    OutcomeCounts others;
    Objections objections;  ///< Against the baseline; nothing for baselines and solo.
    /// Leases over all complete runs, by policy, then action. Nothing where no run has them by action.
    std::optional<std::vector<metrics::LeaseRow>> leases;
    TravelTimeTail travel_time;
    std::vector<MetricSummary> metrics;    ///< In the order of `all_metrics()`.
    std::vector<ApproachCost> approaches;  ///< Against the baseline; empty for baselines.
    std::optional<Recovery> recovery;      ///< Likewise.
    /// In `primary_metric`. Nothing without a solo condition, and for baselines.
    std::optional<GapClosed> gap_closed;
    /// Replications behind `gap_closed`.
    std::size_t gap_replications = 0;

    /// Throws std::out_of_range for an unknown name.
    const MetricSummary& metric(const std::string& name) const;
};

struct ScenarioSummary {
    std::string scenario;
    std::string title;
    std::vector<ConditionSummary> conditions;  ///< In the manifest's order.

    /// Nullptr when the study has no such condition.
    const ConditionSummary* find(const std::string& condition) const;
};

struct Summary {
    results::Manifest manifest;
    double level = usual_level;
    std::vector<ScenarioSummary> scenarios;  ///< In the manifest's order.
};

/// The conditions of `second`, each compared with the condition of the same name in `first`: equal units, so
/// the same scenario, seed and condition, run twice. The summary is that of `second`, without scenarios and
/// conditions that only one of the two has; `baseline` names the condition. Throws core::InputError when the
/// two share no run that was made from the same seed and configuration.
Summary compare_studies(const results::Results& first, const results::Results& second,
                        double level = usual_level);

/// A condition's baseline is the first condition of the same traffic model without policies; its solo times
/// are those of the first condition in free flow. Deterministic.
Summary summarise(const results::Results& results, double level = usual_level);

}  // namespace clearway::analysis
