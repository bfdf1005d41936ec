#pragma once

#include <cstdint>
#include <vector>

#include "roads/network.hpp"

namespace clearway::roads {

/// Which end of a lane lies at a junction.
enum class LaneEnd : std::uint8_t { first, last };

/// A sidewalk where it meets a junction.
struct SidewalkEnd {
    core::LaneIndex lane;
    LaneEnd end = LaneEnd::last;
};

/// A pedestrian crossing and the sidewalks on its two sides. If one side is a traffic island, that side has
/// the sidewalks that the island's other crossings lead to.
struct Crossing {
    core::EdgeIndex edge;
    bool has_signal = false;
    std::vector<SidewalkEnd> one_side;
    std::vector<SidewalkEnd> other_side;
};

/// The crossings that connect sidewalks, in the order of the network's edges.
std::vector<Crossing> crossings(const Network& network);

}  // namespace clearway::roads
