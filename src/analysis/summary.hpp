#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/bootstrap.hpp"
#include "analysis/condition_difference.hpp"
#include "analysis/estimate.hpp"
#include "analysis/met_incident.hpp"
#include "analysis/objections.hpp"
#include "analysis/response.hpp"
#include "analysis/traffic.hpp"
#include "core/settings.hpp"
#include "results/store.hpp"
#include "traffic/refusal.hpp"

namespace clearway::analysis {

/// The kind of a metric's values, which decides its interval.
enum class MetricKind : std::uint8_t {
    quantity,  ///< Durations, shares: `estimate_not_negative`.
    count,     ///< 0, 1, 2, ...: `estimate_count`, never below 0.
};

/// A metric as tables show it. Taken from the field table of metrics::RunMetrics.
struct MetricInfo {
    std::string name;
    std::string unit;
    std::string doc;
    MetricKind kind = MetricKind::quantity;
};

/// One value per replication; nothing where it is missing.
using Values = std::vector<std::optional<double>>;

/// Mean of the values present, with the interval of the metric's kind.
MaybeEstimate estimate_values(const Values& values, MetricKind kind, double level = usual_level);
/// Mean of the paired differences of the replications where both have a value.
MaybeEstimate estimate_paired(const Values& condition, const Values& baseline, MetricKind kind,
                              double level = usual_level);
/// p of the paired t test of those replications. Nothing where they do not differ, or are too few.
std::optional<double> paired_t_p(const Values& condition, const Values& baseline);
/// All metrics of a run that are numbers, in the order of their field table.
std::vector<MetricInfo> all_metrics();

/// The metric of verdicts, headlines, curves and gates: it counts every emergency vehicle, arrived or not.
inline constexpr const char* primary_metric = "emergency_restricted_travel_time_s";

/// A condition against its baseline, in one metric, paired by replication. For metrics of emergency vehicles
/// that are means over those that arrived (`emergency_travel_time_s`, `emergency_time_loss_s`), a
/// replication's pair is the means over the vehicles that arrived in both conditions; the vehicles left out
/// are counted.
struct Comparison {
    std::size_t complete_pairs = 0;
    /// Replications that lack a value in at least one of the two conditions: failed, missing, or without a
    /// vehicle to average over.
    std::size_t incomplete_pairs = 0;
    /// Emergency vehicles of complete pairs that arrived in only one condition or in none.
    std::size_t vehicles_left_out = 0;
    std::vector<double> condition_values;     ///< Of complete pairs, in the order of the replications.
    std::vector<double> baseline_values;      ///< Of the same pairs.
    MaybeEstimate difference;                 ///< Condition - baseline, in the metric's unit.
    MaybeEstimate relative;                   ///< As a share of the baseline's mean.
    std::optional<Interval> bootstrap;        ///< BCa interval of the mean difference; not for counts.
    std::optional<double> median;             ///< Of the paired differences.
    std::optional<Interval> median_interval;  ///< From order statistics.
    /// Complete pairs with a lock in at least one of their runs (metrics::RunMetrics::locks).
    std::size_t locked_pairs = 0;
    std::size_t held_up_pairs = 0;  ///< Of them, those with a run that locks held up (metrics::is_held_up).
    MaybeEstimate unlocked;         ///< The difference over the other pairs; nothing if no pair locked.
    std::optional<double> effect_size;  ///< Cohen's d for pairs, d_z.
    std::optional<double> t_p;          ///< Not for counts, which are far from normal.
    std::optional<double> wilcoxon_p;
    /// `t_p` (for counts `wilcoxon_p`), adjusted over all comparisons of a scenario in this metric.
    std::optional<double> holm_p;
};

/// One cell of a table: a metric in a condition of a scenario.
struct MetricSummary {
    MetricInfo metric;
    Values values;                         ///< By replication.
    MaybeEstimate estimate;                ///< Over the replications that have a value.
    std::optional<Comparison> comparison;  ///< Nothing for the baseline itself and for the solo condition.
};

/// Travel times of all emergency vehicles of a condition. Those that did not arrive rank last.
struct TravelTimeTail {
    /// Trips of which one is beyond the percentile; of fewer it would be the slowest.
    static constexpr std::size_t fewest_trips = 20;
    MaybeEstimate median;
    MaybeEstimate percentile_95;  ///< Nothing below `fewest_trips`.
};

/// A policy of a condition that did nothing, or nothing to others, in some of its runs.
struct IdlePart {
    std::string policy;
    std::size_t idle_runs = 0;  ///< Complete runs in which none of its leases was carried out.
    std::size_t runs = 0;       ///< Complete runs.
    std::size_t own_runs = 0;   ///< Complete runs in which it only changed the emergency vehicle's own lane.
    std::uint64_t vain = 0;     ///< Leases that it issued in idle runs.
    /// Those of them that were refused, by reason.
    std::map<traffic::Refusal, std::uint64_t> refused = {};
};

struct ConditionSummary {
    experiment::ConditionSpec condition;
    std::string baseline;  ///< Condition it is compared with; empty for that one itself and solo.
    /// First condition whose runs have the same traces, all of them complete in both: nothing in which the
    /// two differ ever acted. Empty without.
    std::string same_as;
    std::size_t complete_runs = 0;
    std::size_t failed_runs = 0;
    std::size_t missing_runs = 0;
    OutcomeCounts emergency;
    OutcomeCounts others;
    Objections objections;                  ///< Against the baseline; none for baselines and solo.
    std::vector<metrics::LeaseRow> leases;  ///< Over all complete runs, by policy, then action.
    std::vector<IdlePart> idle_parts;       ///< In the order of the policies.
    TravelTimeTail travel_time;
    ResponseTime response;                 ///< Compared with the baseline where there is one.
    MetIncident met_incident;              ///< Likewise; nobody for baselines.
    std::vector<MetricSummary> metrics;    ///< In the order of `all_metrics()`.
    std::vector<ApproachCost> approaches;  ///< Against the baseline; empty for baselines.
    std::optional<Recovery> recovery;      ///< Likewise.
    /// In `primary_metric`. Nothing for baselines, and without a solo condition.
    MaybeEstimate gap_closed;

    /// Throws std::out_of_range for an unknown name.
    const MetricSummary& metric(std::string_view name) const;
    /// Sum of a metric over the runs.
    double total(std::string_view name) const;
    /// Complete runs with a lock.
    std::size_t locked_runs() const;
};

struct ScenarioSummary {
    std::string scenario;
    std::string title;
    std::vector<ConditionSummary> conditions;  ///< In the manifest's order.

    /// Nullptr when the study has no such condition.
    const ConditionSummary* find(const std::string& condition) const;
};

/// Runs that a comparison should have and does not have.
struct Unpaired {
    std::string scenario;
    std::string condition;  ///< Empty for all of them.
    std::string why;        ///< `1 of 30 runs failed or is missing`, `is only in the first folder`.
};

/// The difference of a condition from its baseline in `primary_metric`, adjusted for the time that emergency
/// vehicles lost in these baselines, by more runs of the baseline than there are pairs.
struct AdjustedDifference {
    std::string scenario;
    std::string condition;
    MaybeEstimate difference;   ///< See `estimate_adjusted`; nothing where it cannot be adjusted.
    std::size_t baselines = 0;  ///< Runs of the baseline behind it.
    std::size_t worth = 0;      ///< Pairs whose interval, not adjusted, would be as narrow.
};

struct Summary {
    results::Manifest manifest;
    double level = usual_level;
    std::vector<ScenarioSummary> scenarios;  ///< In the manifest's order.
    std::vector<Unpaired> unpaired;
    /// In which the conditions of one name of two studies differ; empty for one study.
    std::vector<ConditionDifference> differing;
    /// Builds of the programs that made two studies, if they differ.
    std::optional<std::pair<std::string, std::string>> builds;
    std::vector<AdjustedDifference> adjusted;  ///< Empty unless `adjust_by` filled it.
};

/// Compares each condition of `second` with the condition of the same name in `first`, in the same scenario
/// and with the same seed. The summary is that of `second`, without scenarios and conditions that only one
/// study has, which are listed in `unpaired`; `baseline` is the condition's own name. Throws core::InputError
/// when seeds or scenario configurations differ, or when the studies share no scenario and condition.
Summary compare_studies(const results::Results& first, const results::Results& second,
                        double level = usual_level, std::optional<double> response_threshold_s = {});

/// Fills `Summary::adjusted` by a study of the same seed with more replications that has the baselines.
/// Without a difference stands what cannot be adjusted: fewer pairs than `fewest_for_interval`, pairs that do
/// not differ, baselines without a loss, all with the same one, or fewer than pairs. Names their builds if
/// they differ. Throws core::InputError for another seed, scenario or baseline, or fewer replications.
void adjust_by(const results::Results& baselines, Summary& summary);

/// What conditions are compared with: one condition of the study, by its name; or for each the one that has
/// these levels of factors, `condition.policy` -> `corridor`, and is the same in all others; or for each the
/// best of the others; or its baseline, if none of these is given. The best has the least mean of the primary
/// metric among those that act, have the same failure and factors but for the policy, and no objection on
/// emergency vehicles (analysis::Objections). Chosen by the runs that are then compared, it is favoured.
struct Reference {
    std::string name = {};
    core::Settings levels = {};
    enum class Chosen : std::uint8_t { as_named, best } chosen = Chosen::as_named;

    bool is_best() const { return chosen == Chosen::best; }
    bool is_baseline() const { return name.empty() && levels.empty() && !is_best(); }
};
/// `corridor`, `its counterpart with policy corridor`, `the best other condition`; empty for the baseline.
std::string to_text(const Reference& reference);

/// A condition's baseline is the first condition of the same traffic model without policies; its solo times
/// are those of the first free-flow condition. Without `response_threshold_s`, each scenario has its own (see
/// usual_response_threshold_s). Another reference takes the place of the baseline among the conditions of its
/// environment, and no share of a gap is given. Deterministic.
Summary summarise(const results::Results& results, double level = usual_level,
                  std::optional<double> response_threshold_s = {}, const Reference& reference = {});

}  // namespace clearway::analysis
