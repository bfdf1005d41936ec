#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::metrics {

/// What one class of vehicles lost on one approach during a run, from the fork of the conditions on.
/// Emergency vehicles are left out.
struct ApproachRow {
    std::string edge;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    std::uint64_t vehicles = 0;
    double waiting_time_s = 0.0;
    double time_loss_s = 0.0;
    double flow_per_hour = 0.0;

    bool operator==(const ApproachRow&) const = default;

    /// The numeric columns. In tables, edge and class come before them.
    static constexpr void fields(const auto& table) {
        using R = ApproachRow;
        using core::Field;
        table(Field{"vehicles", "1", &R::vehicles, 0.0, 1e9, "Vehicles that entered the approach", ""},
              Field{"waiting_time_s", "s", &R::waiting_time_s, 0.0, 1e12,
                    "Time that vehicles stood there (below 0.1 m/s), summed over vehicles", ""},
              Field{"time_loss_s", "s", &R::time_loss_s, 0.0, 1e12,
                    "Time lost there compared with driving at the speed limit, summed over vehicles", ""},
              Field{"flow_per_hour", "1/h", &R::flow_per_hour, 0.0, 1e9,
                    "Vehicles per hour that entered it while demand departed", ""});
    }
};

/// Vehicles standing on the other approaches of a signal some time before or after an emergency vehicle
/// passes it: mean over the passages of a run.
struct RecoveryRow {
    double offset_s = 0.0;
    std::uint64_t passages = 0;
    double halted_vehicles = 0.0;

    bool operator==(const RecoveryRow&) const = default;

    static constexpr void fields(const auto& table) {
        using R = RecoveryRow;
        using core::Field;
        table(Field{"offset_s", "s", &R::offset_s, -1e6, 1e6, "Time after the EV passed the stop line", ""},
              Field{"passages", "1", &R::passages, 0.0, 1e9, "Number of passages in the mean", ""},
              Field{"halted_vehicles", "1", &R::halted_vehicles, 0.0, 1e9,
                    "Vehicles below 0.1 m/s on the signal's other approaches, mean", ""});
    }
};

/// A moment of an emergency vehicle's journey: where it was, or what a signal on its route began to show.
struct JourneyRow {
    std::string vehicle;  ///< SUMO's id; text from a file, so printers escape it.
    std::string signal;   ///< Empty: the row is a position of the vehicle.
    std::string state;    ///< `green`, `yellow` or `red` for the vehicle's path; empty without a signal.
    double time_s = 0.0;
    double distance_m = 0.0;

    bool operator==(const JourneyRow&) const = default;

    static constexpr void fields(const auto& table) {
        using R = JourneyRow;
        using core::Field;
        table(Field{"time_s", "s", &R::time_s, 0.0, 1e9, "Simulation time", ""},
              Field{"distance_m", "m", &R::distance_m, 0.0, 1e9,
                    "Distance of the vehicle or the stop line from the start of the route", ""});
    }
};

/// How long an emergency vehicle needed for one edge of its route, the junction behind it included. Edges
/// that it did not drive from their beginning to the next edge are left out, but for the last one, which
/// counts until the vehicle was last seen.
struct EdgeTimeRow {
    std::string vehicle;  ///< SUMO's id; text from a file, so printers escape it.
    std::string edge;
    double entered_s = 0.0;
    double time_s = 0.0;

    bool operator==(const EdgeTimeRow&) const = default;

    static constexpr void fields(const auto& table) {
        using R = EdgeTimeRow;
        using core::Field;
        table(Field{"entered_s", "s", &R::entered_s, 0.0, 1e9, "Simulation time at which it entered the edge",
                    ""},
              Field{"time_s", "s", &R::time_s, 0.0, 1e9,
                    "Time until it entered the next edge; on the last edge until it was last seen", ""});
    }
};

/// How often and how long policies held a signal.
struct SignalHoldRow {
    std::string signal;
    std::uint64_t holds = 0;
    double held_s = 0.0;

    bool operator==(const SignalHoldRow&) const = default;

    static constexpr void fields(const auto& table) {
        using R = SignalHoldRow;
        using core::Field;
        table(Field{"holds", "1", &R::holds, 0.0, 1e9, "Times that a policy began to ask for green", ""},
              Field{"held_s", "s", &R::held_s, 0.0, 1e9,
                    "Time in which it asked for green and one of the links asked for was green", ""});
    }
};

/// An edge beside the way of an emergency vehicle, on ways that a policy considered for it and did not ask
/// for.
struct ConsideredRow {
    std::string vehicle;  ///< SUMO's id; text from a file, so printers escape it.
    std::string edge;
    std::uint64_t decisions = 0;

    bool operator==(const ConsideredRow&) const = default;

    static constexpr void fields(const auto& table) {
        table(core::Field{"decisions", "1", &ConsideredRow::decisions, 0.0, 1e9,
                          "Decisions at which it was on such a way", ""});
    }
};

/// A lock: vehicles stood at a junction over 60 s with no red, no stop and no queue to a red ahead of them.
struct LockRow {
    std::string edge;      ///< On which, or inside the junction behind which, the first of the queue stood.
    std::string junction;  ///< At its end. Both are texts from a file, so printers escape them.
    double from_s = 0.0;
    double lasted_s = 0.0;
    std::uint64_t vehicles = 0;
    std::uint64_t emergency_vehicles = 0;

    bool operator==(const LockRow&) const = default;

    static constexpr void fields(const auto& table) {
        using R = LockRow;
        using core::Field;
        table(Field{"from_s", "s", &R::from_s, 0.0, 1e9, "When the first vehicle came to a stand", ""},
              Field{"lasted_s", "s", &R::lasted_s, 0.0, 1e9, "Until no vehicle stood in it any more", ""},
              Field{"vehicles", "1", &R::vehicles, 0.0, 1e9, "Vehicles that stood in it", ""},
              Field{"emergency_vehicles", "1", &R::emergency_vehicles, 0.0, 1e9, "Of them: EVs", ""});
    }
};

/// The first replications of a condition keep their emergency vehicles' journeys.
inline constexpr std::uint32_t journeys_kept = 3;

/// Where a run lost time, and how its emergency vehicles travelled.
struct TrafficTables {
    std::vector<ApproachRow> approaches;  ///< By edge, then class; no rows without vehicles.
    std::vector<RecoveryRow> recovery;    ///< Ascending; empty where no emergency vehicle passed a signal.
    std::vector<JourneyRow> journeys;     ///< By vehicle; empty where they are not kept.
    std::vector<EdgeTimeRow> edge_times;  ///< By vehicle, in driving order.
    std::vector<SignalHoldRow> holds;     ///< By signal; no rows for signals that were not held.
    std::vector<LockRow> locks;           ///< By start.
    std::vector<ConsideredRow> considered = {};  ///< By vehicle.

    bool operator==(const TrafficTables&) const = default;
};

}  // namespace clearway::metrics
