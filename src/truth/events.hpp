#pragma once

#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"

namespace clearway::truth {

/// `obstacle`: on a lane, with an obstacle of an incident, which the roster does not know.
enum class CollisionPlace : unsigned char { lane, junction, obstacle };

struct Collision {
    core::VehicleKey collider;
    core::VehicleKey victim;  ///< A pedestrian, if the roster does not know it and the place is no obstacle.
    CollisionPlace place = CollisionPlace::lane;
    core::LaneIndex lane;
    bool with_emergency_vehicle = false;
};

/// Braking harder than the vehicle's usual deceleration, as SUMO's own warning defines it.
struct EmergencyBraking {
    core::VehicleKey vehicle;
    float deceleration_mps2 = 0.0F;
};

/// What happened during one step.
struct Events {
    core::Seconds time;
    std::vector<core::VehicleKey> departed;
    std::vector<core::VehicleKey> arrived;
    std::vector<core::VehicleKey> teleported;  ///< Teleports that began in this step.
    std::vector<core::VehicleKey> removed;     ///< Gone without arriving.
    std::vector<Collision> collisions;         ///< New in this step; a lasting contact is one collision.
    std::vector<EmergencyBraking> emergency_brakings;  ///< Begun in this step.

    void clear();
};

}  // namespace clearway::truth
