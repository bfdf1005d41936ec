#include "traffic/belief.hpp"

#include <algorithm>

namespace clearway::traffic {

const BelievedVehicle* BelievedGraph::find(core::VehicleKey key) const {
    const auto found = std::ranges::lower_bound(vehicles, key, {}, &BelievedVehicle::key);
    return found != vehicles.end() && found->key == key ? &*found : nullptr;
}

}  // namespace clearway::traffic
