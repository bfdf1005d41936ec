#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.hpp"
#include "roads/network.hpp"

namespace clearway::roads {

/// Whose permissions count.
enum class Driver : std::uint8_t { car, emergency };

/// Room that a turn needs beyond the way to a stop, m: changes of lane at the usual speed in towns. Assumed.
inline constexpr double turn_room_m = 60.0;

/// Edges outside junctions that the driver may turn into from a lane, or from any lane of an edge; each once,
/// ascending. Allocates.
std::vector<core::EdgeIndex> exits(const Network& network, core::LaneIndex lane, Driver driver);
std::vector<core::EdgeIndex> exits(const Network& network, core::EdgeIndex index, Driver driver);

}  // namespace clearway::roads
