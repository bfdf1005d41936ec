#pragma once

#include <initializer_list>
#include <string>

#include "prediction/predictor.hpp"
#include "support/ascii_scene.hpp"

namespace clearway::prediction::testing {

/// e1 and a1 drive side by side at 20 m/s.
inline constexpr const char* side_by_side = R"(
    10 m per cell, limit 20 m/s, speed 20 m/s
    ..e..........................
    ...a.........................
)";

/// What is known of a scene `age_s` later, when the named vehicles went dark at the time of the drawing and
/// all others report now. The scene itself is moved on; vehicles keep their speed.
inline traffic::Observation after_outage(support::Scene& scene, double age_s,
                                         std::initializer_list<const char*> dark) {
    const traffic::Observation before = support::perfect_observation(scene);
    scene.pass(core::Seconds(age_s));
    traffic::Observation now = support::perfect_observation(scene);
    for (const char* id : dark) {
        traffic::ObservedVehicle& vehicle = now.vehicles[scene.row(id)];
        vehicle = before.vehicles[scene.row(id)];
        vehicle.freshness = traffic::Freshness::stale;
        vehicle.age_s = static_cast<float>(age_s);
    }
    return now;
}

/// Probability of the link between two vehicles of a scene in a belief; nothing when it is not listed.
inline std::optional<float> link(const support::Scene& scene, const traffic::BelievedGraph& belief,
                                 const char* one, const char* other) {
    const traffic::BelievedVehicle* const from = belief.find(scene.key(one));
    if (from == nullptr) return std::nullopt;
    for (const traffic::BelievedLink& found :
         belief.links_of(static_cast<core::VehicleIndex>(from - belief.vehicles.data()))) {
        if (belief.vehicles[found.neighbour].key == scene.key(other)) return found.probability;
    }
    return std::nullopt;
}

}  // namespace clearway::prediction::testing
