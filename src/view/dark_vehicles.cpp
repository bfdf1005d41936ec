#include "view/dark_vehicles.hpp"

#include <algorithm>

namespace clearway::view {

std::vector<core::VehicleKey> dark_vehicles(const truth::Snapshot& snapshot,
                                            const traffic::Observation& observation) {
    std::vector<core::VehicleKey> dark;
    auto seen = observation.vehicles.begin();
    for (const core::VehicleKey key : snapshot.key) {
        seen = std::find_if(seen, observation.vehicles.end(),
                            [key](const traffic::ObservedVehicle& each) { return !(each.key < key); });
        const bool is_fresh = seen != observation.vehicles.end() && seen->key == key &&
                              seen->freshness == traffic::Freshness::fresh;
        if (!is_fresh) dark.push_back(key);
    }
    return dark;
}

}  // namespace clearway::view
