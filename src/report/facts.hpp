#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/failure_curve.hpp"

namespace clearway::report {

/// What the tables show, in their order. The first three are the dissertation's columns.
enum class Measure : std::uint8_t {
    emergency_waiting_time,
    emergency_depart_delay,
    waiting_time,
    emergency_travel_time,
    emergency_time_loss,
    gap_closed,
    other_time_loss,
    depart_delay,
    collisions,
    teleports,
    unfinished,
};
inline constexpr std::size_t measure_count = 11;

/// What a difference means.
enum class Better : std::uint8_t { lower, higher };

/// How a measure is named and printed.
struct MeasureInfo {
    Measure measure;
    const char* field;  ///< Name in JSON, unit included.
    const char* title;
    const char* unit;  ///< As printed: `s`, `%`, `per run`.
    const char* doc;   ///< One sentence for readers.
    Better better;
    double printed_factor;  ///< From the field's unit to the printed one: 100 for %, else 1.
};

/// All measures, indexed by `Measure`.
const std::array<MeasureInfo, measure_count>& measures();
const MeasureInfo& info(Measure measure);

/// A mean over replications with its 95 % interval. A single replication has no interval.
struct Estimate {
    std::optional<double> mean;
    std::optional<double> low;   ///< Exists together with `high`.
    std::optional<double> high;  ///< 95 %.
    std::uint64_t count = 0;     ///< Replications (of a difference: complete pairs) behind it.

    bool has_interval() const { return low.has_value() && high.has_value(); }
};

/// One measure of one condition.
struct Outcome {
    Estimate value;
    Estimate
        difference;  ///< Paired, to the baseline of the same replications; empty where nothing is compared.
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
    std::string title;   ///< As in the dissertation where it has the condition, else the name.
    std::string recipe;  ///< Failure, predictor and policy parts, in words.
    /// Index in the scenario of the condition that it is compared with (same engine). Empty for a baseline
    /// and for EVs alone on the road, which are a floor and not a condition to judge.
    std::optional<std::size_t> baseline;
    bool safety_checks_off = false;
    std::array<Outcome, measure_count> outcomes;
    Endings emergency;
    Endings others;
    std::uint64_t runs = 0;          ///< Completed.
    std::uint64_t missing_runs = 0;  ///< Neither completed nor failed: the study is not at its end.
    std::vector<FailedRun> failed;
    Distribution travel_time;

    bool is_compared() const { return baseline.has_value(); }
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
    std::string title;
    std::string attribution;  ///< Whom the map data must name; may be empty.
    std::string network_svg;  ///< Trusted markup, or empty where the folder holds no usable picture.
    std::optional<std::vector<WideEdge>> wide_edges;  ///< By id; empty where the folder does not tell.
    std::uint64_t replications = 0;
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
    std::vector<FailureCurve> failure_curves;
    std::vector<LossCurve> curves;
    std::vector<Provenance> provenance;
    std::string command;  ///< That makes the same study again.
};

}  // namespace clearway::report
