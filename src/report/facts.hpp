#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/planned_findings.hpp"
#include "analysis/summary.hpp"
#include "core/settings.hpp"
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
/// The measure of verdicts: analysis::primary_metric.
inline constexpr Measure primary = Measure::emergency_restricted_time;

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
/// `EV travel time, all, s`: title, what of it (`difference`; may be empty) and unit, for axes and columns.
std::string labelled(Measure measure, const std::string& what = "");

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
    std::optional<std::uint64_t> needed_unlocked =
        {};  ///< Without the pairs that locked; nothing if none did.
};
/// Larger numbers of replications are not suggested: the user should accept a larger difference.
inline constexpr std::uint64_t most_replications_asked = 200;
inline constexpr std::size_t precision_points = 200;

/// A counted flow and the flow of the baseline's runs at the same place.
struct FlowFacts {
    std::string edge;
    double counted_per_hour = 0.0;
    std::optional<double> modelled_per_hour;  ///< Mean over the runs; nothing without a complete run.
    std::optional<double> geh;
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

/// The metrics of what happened to the actions of a policy and on the road.
inline constexpr std::array event_metrics = {"leases_issued", "leases_refused",       "leases_expired",
                                             "collisions",    "emergency_collisions", "teleports"};

/// The emergency vehicle of a condition that took longest; one that did not arrive took longer than all that
/// did.
struct WorstTrip {
    std::string vehicle;  ///< SUMO's id; text from a file, so printers escape it.
    std::uint32_t replication = 0;
    double seconds = 0.0;  ///< Of the trip, or until its end if it did not arrive.
    /// `teleported at 1,301 s`; empty if it arrived.
    std::string end = {};
};

/// The seconds by which a trip is faster than that of the same EV in the baseline.
struct TripGain {
    std::uint32_t replication = 0;
    std::string vehicle;
    double gain_s = 0.0;
};

/// How the trips of a condition differ from the same EVs' in its baseline, of those that arrived in both.
struct TripChanges {
    std::uint64_t trips = 0;
    std::uint64_t faster = 0;    ///< By more than `felt_s`.
    std::uint64_t slower = 0;    ///< Likewise.
    double mean_faster_s = 0.0;  ///< Of those that are faster; positive.
    std::vector<TripGain> gains = {};
};
inline constexpr double felt_s = 5.0;

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

using analysis::MaybeEstimate;
using analysis::mean_of;
using analysis::shown_interval;

/// What is known of a condition, and how a report presents it. Its metrics hold those of every `Measure`.
struct ConditionFacts : analysis::ConditionSummary {
    std::string title;            ///< In words: experiment::ConditionTitles.
    std::string base_title = {};  ///< Of what factors made it from.
    std::string recipe;           ///< Failure, predictor and policies, in words.
    /// The condition of which a part is off in this one (StudyConfig::controls); empty for no control.
    std::string control_of = {};
    core::Settings factors;  ///< Of the study, with those of the scenario: `failure.dark_share` -> `0.3`.
    core::Settings factor_titles = {};  ///< Of some of their values, for figures.
    /// All in which conditions can differ, in words: `policy` -> `Ours`, `failure` -> `B10`.
    core::Settings aspects = {};
    bool knows_truth = false;       ///< Its predictor is no repair: it is given the truth.
    double least_relevant_s = 0.0;  ///< Smaller mean differences of EV times do not count.
    std::vector<FailedRun> failed;
    Distribution distribution;  ///< Of EV travel times.
    std::optional<WorstTrip> worst_trip;
    TripChanges trip_changes;
    std::optional<Precision> precision;  ///< Nothing below two pairs.

    const std::string& name() const { return condition.name; }
    /// Not so for baselines, and for EVs alone on the road, which are a lower bound and not a condition to
    /// judge.
    bool is_compared() const { return !baseline.empty(); }
    bool is_unchecked() const { return condition.safety_checks == traffic::SafetyChecks::off; }
    /// The name for tables, legends and figures: the title, with marks if safety checks were off and if it
    /// knows the truth.
    std::string label() const {
        return title + (is_unchecked() ? " (!)" : "") + (knows_truth ? " (knows the truth)" : "");
    }
    const analysis::MetricSummary& outcome(Measure measure) const { return metric(info(measure).field); }
    const MaybeEstimate& value(Measure measure) const { return outcome(measure).estimate; }
    /// Paired, to the baseline of the same replications; nothing if nothing is compared.
    const MaybeEstimate& difference(Measure measure) const {
        static const MaybeEstimate none;
        const auto& comparison = outcome(measure).comparison;
        return comparison ? comparison->difference : none;
    }
    /// Smaller mean differences do not count; in the measure's unit.
    double least_relevant(Measure measure) const {
        return info(measure).relevance == Relevance::least ? least_relevant_s : 0.0;
    }
    std::uint64_t count(std::string_view metric) const { return static_cast<std::uint64_t>(total(metric)); }
};

/// Whether a vehicle that has stood in a junction for long still blocks it
/// (`time.ignore_junction_blocker_s`).
enum class Blockers : std::uint8_t { ignored, respected };

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
    std::string variant;  ///< `dense`; empty: the standard one.
    /// What its emergency vehicles are called: `ambulances` where all are, else `emergency vehicles`.
    std::string emergency_noun = "emergency vehicles";
    std::string attribution;  ///< Credit that the map data requires; may be empty.
    /// What its figures rest on, a sentence: demand, EVs at red lights. Empty if the manifest does not say.
    std::string assumptions;
    /// What to expect of preemption, a sentence with text from a file; empty without signals.
    std::string outlook;
    std::string network_svg;  ///< Trusted markup, or empty if the folder has no usable picture.
    std::optional<std::vector<WideEdge>> wide_edges;  ///< By id; nothing if the folder does not list them.
    std::optional<RoadMap> roads;                     ///< Nothing if the folder does not list them.
    std::map<std::string, std::string> streets;       ///< Their names, by edge.
    double step_length_s = 0.0;                       ///< Of the simulation; 0 if the manifest does not say.
    double horizon_s = 0.0;  ///< What an EV that did not arrive counts with, likewise.
    Blockers blockers = Blockers::respected;
    std::uint64_t replications = 0;
    std::string chosen = {};  ///< Name of the condition that the user wants shown; empty: none.
    double least_relevant_s = usual_least_relevant_s;
    double response_threshold_s = 0.0;       ///< Of an EV trip that is in time; 0 if no EV arrived.
    std::vector<FlowFacts> flows;            ///< In the order of the counts; empty without counts.
    std::vector<JourneyFacts> journeys;      ///< Of one EV: baseline, headline's, some others.
    std::optional<ScenarioMap> map;          ///< Nothing where the files of the runs do not hold it.
    std::vector<ConditionFacts> conditions;  ///< The baseline first.

    /// Place of a condition by its name; the number of conditions if there is none.
    std::size_t place_of(const std::string& condition) const;
    /// What a condition is compared with (same traffic model); null where nothing is.
    const ConditionFacts* baseline_of(const ConditionFacts& condition) const;
    /// The condition that its map is about; null without a map, and where that condition is left out.
    const ConditionFacts* of_map() const;
    /// `Long Street (edge1)`, or the edge alone.
    std::string place_name(const std::string& edge) const;
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
    std::string command;     ///< Repeats the study.
    std::string study_file;  ///< Its text; empty where it has none.
    /// With what conditions are compared instead of their baselines; empty otherwise.
    std::string reference = {};
    /// Whether figures let the condition of the headline stand out; a text of its own has no headline.
    bool headline_leads = true;
};

}  // namespace clearway::report
