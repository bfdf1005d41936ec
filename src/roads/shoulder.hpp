#pragma once

#include "roads/network.hpp"

namespace clearway::roads {

/// Narrower lanes are no place to stop a car, m.
inline constexpr float least_shoulder_m = 2.0F;

/// Whether the outermost lane of an edge is one beside the carriageway on which a car can stop: closed to
/// cars, emergency vehicles and pedestrians, and at least 2 m wide. A hard shoulder is one, and so is a wide
/// lane for buses or bicycles.
inline bool has_shoulder(const Network& network, core::EdgeIndex edge) {
    if (network.edge(edge).internal || network.edge(edge).lane_count < 2) return false;
    const Lane& lane = network.lane(network.lane_of(edge, 0));
    return !lane.allows_cars && !lane.allows_emergency && !lane.allows_pedestrians &&
           lane.width_m >= least_shoulder_m;
}

}  // namespace clearway::roads
