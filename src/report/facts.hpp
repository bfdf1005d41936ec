#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/estimate.hpp"
#include "analysis/objections.hpp"
#include "analysis/planned_findings.hpp"
#include "core/settings.hpp"
#include "metrics/lease_row.hpp"
#include "report/failure_curve.hpp"
#include "report/map.hpp"
#include "report/sensitivity.hpp"

namespace clearway::report {

/// What the tables show, in their order. The first three are the dissertation's columns.
enum class Measure : std::uint8_t {
    emergency_waiting_time,
    emergency_depart_delay,
    waiting_time,
    emergency_restricted_time,
    emergency_travel_time,
    emergency_time_loss,
    gap_closed,
    other_time_loss,
    depart_delay,
    collisions,
    teleports,
    unfinished,
};
inline constexpr std::size_t measure_count = 12;

/// Which direction of a measure is better.
enum class Better : std::uint8_t { lower, higher };

/// Which differences of a measure matter.
enum class Relevance : std::uint8_t {
    any,    ///< Every certain one: fractions of a second add up over all vehicles, and each collision counts.
    least,  ///< Those of at least `usual_least_relevant_s` or the user's value: times of an EV.
};
/// Smallest difference of an EV's time that a verdict calls an effect, s. Assumed: a dispatcher would not
/// notice less, and it is four steps of the simulation.
inline constexpr double usual_least_relevant_s = 1.0;

/// How a measure is named and printed.
struct MeasureInfo {
    Measure measure;
    const char* field;  ///< Name in JSON, unit included.
    const char* title;
    const char* unit;  ///< As printed: `s`, `%`, `per run`.
    const char* doc;   ///< One sentence for readers.
    Better better;
    Relevance relevance;
    double printed_factor;  ///< From the field's unit to the printed one: 100 for %, else 1.
};

/// All measures, indexed by `Measure`.
const std::array<MeasureInfo, measure_count>& measures();
const MeasureInfo& info(Measure measure);

/// A mean over replications with its 95 % interval. Fewer than `analysis::fewest_for_interval` replications
/// have none.
struct Estimate {
    std::optional<double> mean;
    std::optional<double> low;   ///< Exists together with `high`.
    std::optional<double> high;  ///< 95 %.
    std::uint64_t count = 0;     ///< Replications (of a difference: complete pairs) behind it.

    bool too_few() const { return mean.has_value() && count < analysis::fewest_for_interval; }
    bool has_interval() const { return low.has_value() && high.has_value() && !too_few(); }
};

/// Statistics of a paired difference besides its mean and t interval.
struct PairedStatistics {
    std::uint64_t complete_pairs = 0;
    std::uint64_t incomplete_pairs = 0;   ///< Replications without a value in one of the two conditions.
    std::uint64_t vehicles_left_out = 0;  ///< EVs of complete pairs that did not arrive in both.
    Estimate bootstrap;                   ///< The mean difference again, with its BCa interval.
    Estimate median;                      ///< Of the differences, with an interval from order statistics.
    std::optional<double> effect_size;    ///< Cohen's d for pairs, d_z.
    std::optional<double> t_p;
    std::optional<double> wilcoxon_p;
    std::optional<double> holm_p;  ///< Over the conditions of the scenario.
};

/// One measure of one condition.
struct Outcome {
    Estimate value;
    /// Paired, to the baseline of the same replications; empty if nothing is compared.
    Estimate difference;
    double least_relevant = 0.0;  ///< Smaller mean differences do not count; in the measure's unit.
    std::optional<PairedStatistics> paired;
};

/// How vehicles ended.
struct Endings {
    std::uint64_t arrived = 0;
    std::uint64_t running = 0;  ///< On the road when the run ended.
    std::uint64_t teleported = 0;
    std::uint64_t not_inserted = 0;
    std::uint64_t removed = 0;

    std::uint64_t all() const { return arrived + running + teleported + not_inserted + removed; }
};

/// What happened to the actions of a condition's policy and to its vehicles, over all completed runs.
struct Events {
    std::uint64_t leases_issued = 0;
    std::uint64_t leases_refused = 0;
    std::uint64_t leases_expired = 0;
    std::uint64_t collisions = 0;
    std::uint64_t emergency_collisions = 0;
    std::uint64_t teleports = 0;
};

/// One row of a condition's table of safety, comfort and flow.
struct SafetyFacts {
    const char* metric = "";            ///< Name in the tables of runs, unit included; static storage.
    const char* title = "";             ///< With the unit; static storage.
    Estimate value;                     ///< Per run.
    Estimate difference;                ///< Paired, to the baseline; empty if nothing is compared.
    std::optional<double> per_1000_km;  ///< For counts: over all runs, per 1,000 vehicle-kilometres.
};

/// EV travel times of one replication, s: restricted means over all EVs.
struct TravelTimePair {
    double baseline_s = 0.0;
    double condition_s = 0.0;
};

/// Half width of the interval of the difference in restricted mean EV travel time after a number of
/// replications.
struct PrecisionPoint {
    std::uint64_t replications = 0;
    double half_width_s = 0.0;
};

/// Whether a condition has enough replications.
struct Precision {
    std::vector<PrecisionPoint> points;  ///< From five replications on, at most `precision_points` of them.
    double deviation_s = 0.0;            ///< Of the paired differences.
    std::uint64_t needed = 0;            ///< For a half width of the least relevant difference (FHWA's rule).
};
/// Larger numbers of replications are not suggested: the user should accept a larger difference.
inline constexpr std::uint64_t most_replications_asked = 200;
inline constexpr std::size_t precision_points = 200;

/// What a condition costs on one approach against the baseline, s per run, summed over all vehicles that are
/// not EVs.
struct ApproachFacts {
    std::string edge;
    std::string street;   ///< May be empty.
    Estimate difference;  ///< Time lost.
    Estimate human;       ///< Of it, human-driven vehicles.
    Estimate automated;   ///< Of it, automated vehicles.
    Estimate waiting;     ///< Waiting time.
    std::optional<double> baseline_s;
    std::optional<double> vehicles;       ///< Per run, in the baseline.
    std::optional<double> per_vehicle_s;  ///< Mean difference per vehicle.
};

/// A counted flow and the flow of the baseline's runs at the same place.
struct FlowFacts {
    std::string edge;
    std::string street;  ///< May be empty.
    double counted_per_hour = 0.0;
    std::optional<double> modelled_per_hour;  ///< Mean over the runs; nothing without a complete run.
    std::optional<double> geh;
};

/// Difference to the baseline in halted vehicles on the other approaches of a signal, around an EV's passage.
struct RecoveryFacts {
    double offset_s = 0.0;
    Estimate halted;
};

/// A moment of an EV's journey; times count from its departure.
struct JourneyPlace {
    double time_s = 0.0;
    double distance_m = 0.0;
};
/// A state that a signal on the EV's route showed to it for some time.
struct SignalSpan {
    std::string signal;
    std::string state;  ///< `green`, `yellow`, `red`.
    double distance_m = 0.0;
    double from_s = 0.0;
    double to_s = 0.0;
};
/// One EV in one run.
struct JourneyFacts {
    std::string vehicle;
    std::string condition;  ///< Its title.
    std::uint32_t replication = 0;
    std::vector<JourneyPlace> places;
    std::vector<SignalSpan> signals;
};

/// A run without a result.
struct FailedRun {
    std::uint32_t replication = 0;
    std::string cause;
};

/// A point of an empirical distribution: `share` of all vehicles took at most `seconds`.
struct SharePoint {
    double seconds = 0.0;
    double share = 0.0;
};

/// EV travel times of a condition. The share refers to all EVs, arrived or not, so that a curve that stays
/// below 1 shows those that did not.
struct Distribution {
    std::vector<SharePoint> points;  ///< Ascending; at most `distribution_points` of them.
    std::uint64_t arrived = 0;
    std::uint64_t all = 0;
};
inline constexpr std::size_t distribution_points = 200;  // as many as a figure of 400 px can show

struct ConditionFacts {
    std::string name;
    std::string title;       ///< As in the dissertation where it has the condition, else the name.
    std::string recipe;      ///< Failure, predictor and policies, in words.
    core::Settings factors;  ///< Of the study, with those of the scenario: `failure.dark_share` -> `0.3`.
    /// Index in the scenario of the condition that it is compared with (same traffic model). Empty for a
    /// baseline and for EVs alone on the road, which are a lower bound and not a condition to judge.
    std::optional<std::size_t> baseline;
    bool safety_checks_off = false;
    analysis::Objections objections;  ///< Against the baseline.
    bool has_policy = false;
    bool knows_truth = false;  ///< Its predictor is no repair: it is given the truth.
    std::vector<analysis::IdlePart> idle_parts;
    /// What its policy asked for, over all complete runs; nothing if the records do not contain it.
    std::optional<std::vector<metrics::LeaseRow>> leases;
    std::array<Outcome, measure_count> outcomes;
    std::uint64_t runs_without_horizon = 0;  ///< See analysis::ConditionSummary.
    Endings emergency;
    Endings others;
    std::uint64_t runs = 0;          ///< Completed.
    std::uint64_t missing_runs = 0;  ///< Neither completed nor failed: the study is incomplete.
    std::vector<FailedRun> failed;
    Distribution travel_time;
    Estimate travel_time_median;         ///< Over all EVs; without a value if fewer than half arrived.
    Estimate travel_time_percentile_95;  ///< Likewise.
    /// Over all EVs; one that did not arrive counts with the horizon. See analysis::ResponseTime.
    Outcome response_percentile_90;
    Outcome response_in_time;  ///< Share of trips within ScenarioFacts::response_threshold_s.
    std::vector<TravelTimePair> travel_time_pairs;  ///< Complete ones, in the order of the replications.
    std::optional<Precision> precision;             ///< Nothing below two pairs.
    Events events;
    std::vector<SafetyFacts> safety;        ///< In the order of the table.
    std::vector<ApproachFacts> approaches;  ///< Largest changes first; empty if nothing is compared.
    std::vector<RecoveryFacts> recovery;    ///< Ascending; likewise.
    std::optional<double> recovered_after_s;

    bool is_compared() const { return baseline.has_value(); }
    /// The name for tables, legends and figures: the title, with marks if safety checks were off and if it
    /// knows the truth.
    std::string label() const {
        return title + (safety_checks_off ? " (!)" : "") + (knows_truth ? " (knows the truth)" : "");
    }
    const Outcome& outcome(Measure measure) const { return outcomes[static_cast<std::size_t>(measure)]; }
    Outcome& outcome(Measure measure) { return outcomes[static_cast<std::size_t>(measure)]; }
};

/// An edge with at least three lanes for cars; the dissertation's networks are said to have fewer.
struct WideEdge {
    std::string edge;
    std::string street;  ///< May be empty.
    int car_lanes = 0;
};

struct ScenarioFacts {
    std::string name;
    /// Scenario of the dissertation whose published numbers are shown; empty in other studies.
    std::string published_as;
    std::string title;
    /// What its emergency vehicles are called: `ambulances` where all are, else `emergency vehicles`.
    std::string emergency_noun = "emergency vehicles";
    std::string attribution;  ///< Credit that the map data requires; may be empty.
    std::string network_svg;  ///< Trusted markup, or empty if the folder has no usable picture.
    std::optional<std::vector<WideEdge>> wide_edges;  ///< By id; nothing if the folder does not list them.
    std::optional<std::uint64_t> signals;             ///< Of the network; nothing if the folder does not say.
    double step_length_s = 0.0;                       ///< Of the simulation; 0 if the manifest does not say.
    std::uint64_t replications = 0;
    double least_relevant_s = usual_least_relevant_s;
    double response_threshold_s = 0.0;       ///< Of an EV trip that is in time; 0 if no EV arrived.
    std::vector<FlowFacts> flows;            ///< In the order of the counts; empty without counts.
    std::vector<JourneyFacts> journeys;      ///< Of one EV under some of the conditions.
    std::optional<ScenarioMap> map;          ///< Nothing where the files of the runs do not hold it.
    std::vector<ConditionFacts> conditions;  ///< The baseline first.
};

/// One training: losses over epochs.
struct LossCurve {
    std::string title;
    std::string held_out = "test";  ///< What `test` was measured on.
    std::string note;
    std::optional<double> constant_loss;  ///< Test loss of the best constant answer, nat.
    std::vector<double> epoch;
    std::vector<double> train;  ///< nat; not finite where training broke down.
    std::vector<double> test;
};

/// A name and its value in the section on reproduction: command, versions, hashes, seeds.
using Provenance = std::pair<std::string, std::string>;

/// All that the tables and the report show.
struct StudyFacts {
    std::string title;
    std::vector<ScenarioFacts> scenarios;
    std::optional<results::AnalysisPlan> plan;
    std::vector<analysis::PlannedFinding> planned;  ///< Of the plan, in its order.
    std::vector<FailureCurve> failure_curves;
    std::vector<Sensitivity> sensitivities;
    std::vector<LossCurve> curves;
    std::vector<Provenance> provenance;
    std::string command;  ///< Repeats the study.
};

}  // namespace clearway::report
