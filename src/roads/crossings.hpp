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

/// A crossing for pedestrians and the sidewalks on its two sides; where an island lies on one side, the
/// sidewalks behind the crossings beyond it.
struct Crossing {
    core::EdgeIndex edge;
    bool has_signal = false;
    std::vector<SidewalkEnd> one_side;
    std::vector<SidewalkEnd> other_side;
};

/// The crossings that lead from sidewalks to others, in the order of the network's edges.
std::vector<Crossing> crossings(const Network& network);

}  // namespace clearway::roads
