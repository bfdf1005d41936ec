#pragma once

#include <vector>

#include "roads/network.hpp"

namespace clearway::roads {

/// Below this length policies call a block short: docs/findings/short-blocks.md.
inline constexpr double usual_short_block_m = 150.0;

/// Signals at which a queue can close upon itself: those left when signals joined to fewer than two others by
/// blocks shorter than `shorter_than_m` are taken away again and again, so those on closed loops of such
/// blocks, and between such loops. A block is a street from one signal to the next: one edge, or several of
/// which each leads to the next alone, as in maps that cut streets where a name or a limit changes. Signals
/// less than 25 m apart stand at one place, as those of the two carriageways of a street, which alone make no
/// loop. Queues that stand around a closed loop let nobody out of it, however green the signals are (C. F.
/// Daganzo, Urban gridlock, Transportation Research Part B 41 (2007) 49-62); along a chain they end at its
/// end. By signal; empty if there are none. Allocates.
std::vector<bool> on_short_loops(const Network& network, double shorter_than_m);

}  // namespace clearway::roads
