#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "traffic/incident.hpp"
#include "traffic/signal.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::traffic {

/// What one report says of a vehicle's motion. Position is that of the front bumper in the network's plane.
struct MotionState {
    float x_m = 0.0F;
    float y_m = 0.0F;
    float heading_rad = 0.0F;  ///< Counter-clockwise from the x axis.
    float speed_mps = 0.0F;
    core::LaneIndex lane;          ///< May be an internal lane of a junction.
    float lane_position_m = 0.0F;  ///< Of the front bumper from the start of the lane.
    /// Position in the route of the last edge outside junctions that was entered.
    std::uint32_t route_edge = 0;
};

/// Whether the newest report of a vehicle arrived.
enum class Freshness : std::uint8_t {
    fresh,  ///< It reported at the latest report time.
    stale,  ///< Its latest report was lost; `age_s` > 0.
};

/// What is known of one vehicle from its latest report.
struct ObservedVehicle {
    core::VehicleKey key;
    VehicleClass vehicle_class = VehicleClass::human;
    Freshness freshness = Freshness::fresh;
    float age_s = 0.0F;             ///< Time since the state below was measured, s.
    float position_sigma_m = 0.0F;  ///< Standard error that the sensor states, m; 0 if perfect.
    MotionState state;
};

/// A dark vehicle still detected by a neighbour: a link without a position.
struct DetectedLink {
    core::VehicleKey from;  ///< The vehicle that detects.
    core::VehicleKey to;
    float range_m = -1.0F;  ///< Measured distance, or negative when only presence is known.
    float range_sigma_m = 0.0F;
};

/// What the sensors reported up to `time`. Vehicles that never reported are absent. Ordered by key.
struct Observation {
    core::Seconds time;
    core::Seconds report_time;  ///< Time of the latest report round, <= time.
    bool is_report = false;     ///< A report round took place at `time`.
    bool exits_known = true;    ///< Vehicles that left the network are absent: every exit has a detector.
    std::vector<ObservedVehicle> vehicles;
    /// What each emergency vehicle knows of itself, fresh, whether or not others see it. Ordered by key.
    std::vector<ObservedVehicle> own_states;
    std::vector<DetectedLink> detected_links;
    SignalStates signals;
    std::vector<KnownIncident> incidents;  ///< That last and are known.
    /// Registrations and routes of the vehicles that reported at least once, and of all emergency vehicles.
    const Roster* roster = nullptr;
};

}  // namespace clearway::traffic
