#pragma once

#include <span>

#include "metrics/counts.hpp"
#include "metrics/road_layout.hpp"
#include "roads/network.hpp"
#include "traffic/departure.hpp"

namespace clearway::loop {

/// What the recorder of a run has to know of the map and of the routes of its emergency vehicles. A route
/// ends where the network does not connect its edges; counts of unknown edges are left out. Approaches are in
/// the order of the network's edges. The network outlives the layout.
metrics::RoadLayout road_layout(const roads::Network& network,
                                std::span<const traffic::EmergencyDeparture> emergency,
                                std::span<const metrics::EdgeCount> counts = {});

}  // namespace clearway::loop
