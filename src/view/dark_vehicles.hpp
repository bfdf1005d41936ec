#pragma once

#include <vector>

#include "core/ids.hpp"
#include "traffic/observation.hpp"
#include "truth/snapshot.hpp"

namespace clearway::view {

/// Vehicles on the road whose newest report did not arrive, or that never reported. Ascending. For the eyes
/// of a person: nothing that makes decisions may ask this.
std::vector<core::VehicleKey> dark_vehicles(const truth::Snapshot& snapshot,
                                            const traffic::Observation& observation);

}  // namespace clearway::view
