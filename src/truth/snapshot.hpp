#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "traffic/observation.hpp"
#include "traffic/signal.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::truth {

/// A vehicle parked beside the road: it blocks no other vehicle and no sensor sees it, but it receives
/// requests.
struct BesideRoad {
    core::VehicleKey key;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    traffic::MotionState state;  ///< The lane is the one that it left.
};

/// The true state of all vehicles on the road at one step, as a structure of arrays. Rows are ordered by key;
/// a row number (`core::VehicleIndex`) is valid for this snapshot alone. Buffers keep their capacity between
/// steps.
struct Snapshot {
    core::Seconds time;
    std::vector<core::VehicleKey> key;
    std::vector<traffic::VehicleClass> vehicle_class;
    std::vector<float> x_m;  ///< Front bumper.
    std::vector<float> y_m;
    std::vector<float> heading_rad;  ///< Counter-clockwise from the x axis.
    std::vector<float> speed_mps;
    std::vector<float> acceleration_mps2;
    std::vector<core::LaneIndex> lane;
    std::vector<float> lane_position_m;
    std::vector<std::uint32_t> route_edge;  ///< See traffic::MotionState.
    traffic::SignalStates signals;
    std::vector<BesideRoad> beside_road;  ///< Vehicles without a row, ordered by key.
    /// Vehicles that stand at a stop because a command says so, on a lane or beside the road. SUMO counts
    /// that as a planned stop: neither as waiting nor as time lost.
    std::vector<core::VehicleKey> commanded_stops;

    std::size_t size() const { return key.size(); }
    void resize(std::size_t rows);
    /// Row of a vehicle, or nothing when it is not on the road. O(log n).
    std::optional<core::VehicleIndex> row_of(core::VehicleKey vehicle) const;
    /// One row as a report would carry it.
    traffic::MotionState motion(core::VehicleIndex row) const;
};

}  // namespace clearway::truth
