#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "traffic/observation.hpp"

namespace clearway::traffic {

/// What is believed of one vehicle now.
struct BelievedVehicle {
    core::VehicleKey key;
    VehicleClass vehicle_class = VehicleClass::human;
    MotionState state;     ///< Believed present state. `lane` may be none.
    float sigma_m = 0.0F;  ///< Standard deviation of the position along the route, m.
    float age_s = 0.0F;    ///< Age of the report that the belief rests on, s.
};

/// A link that is believed to exist, seen from one of its ends.
struct BelievedLink {
    core::VehicleIndex neighbour = 0;
    float distance_m = 0.0F;   ///< Believed distance.
    float probability = 1.0F;  ///< That the true distance is below the link radius.
};

/// Believed states and links: all that a policy sees. It cannot tell whether they are true, observed or
/// repaired. Vehicles are ordered by key; links are stored both ways in CSR form, each row ordered by
/// neighbour.
struct BelievedGraph {
    core::Seconds time;
    std::vector<BelievedVehicle> vehicles;
    std::vector<std::uint32_t> first_link;  ///< Size vehicles + 1.
    std::vector<BelievedLink> links;
    /// What each emergency vehicle knows of itself (see Observation). Ordered by key.
    std::vector<BelievedVehicle> own_states;
    SignalStates signals;
    std::vector<KnownIncident> incidents;  ///< That last and are known.
    const Roster* roster = nullptr;

    std::span<const BelievedLink> links_of(core::VehicleIndex vehicle) const {
        return std::span(links).subspan(first_link[vehicle], first_link[vehicle + 1] - first_link[vehicle]);
    }
    /// Number of undirected links.
    std::size_t link_count() const { return links.size() / 2; }
    /// Row of a vehicle, or nothing.
    const BelievedVehicle* find(core::VehicleKey key) const;
};

}  // namespace clearway::traffic
