#pragma once

#include <vector>

#include "core/ids.hpp"
#include "roads/reach.hpp"

namespace clearway::scenario::detail {

/// Draws the ends of trips where not all edges reach each other. The weight of an edge is its share of the
/// total length, plus, where traffic can only enter (or leave) the network, its share of the lanes of all
/// such edges.
class ReachableEnds {
  public:
    /// `edges`: those on which trips may start and end, ascending, not empty.
    ReachableEnds(const roads::Network& network, std::vector<core::EdgeIndex> edges);

    /// Where a trip starts, by a uniform number in [0, 1).
    core::EdgeIndex origin(double uniform) const;
    /// The other end of a trip that starts at `end` (way onward) or ends there (way back), but not `end`
    /// itself; `none` if there is none.
    core::EdgeIndex other_end(core::EdgeIndex end, roads::Way way, double uniform) const;

  private:
    roads::Reach reach_;
    std::vector<core::EdgeIndex> edges_;
    std::vector<double> from_weight_, to_weight_;  ///< By row of edges_.
};

}  // namespace clearway::scenario::detail
