#pragma once

#include <cstdint>
#include <vector>

#include "roads/network.hpp"

namespace clearway::roads {

/// Edges outside junctions with a lane open to cars, ascending.
std::vector<core::EdgeIndex> car_edges(const Network& network);

/// Seen from an edge: what it leads to, or what leads to it.
enum class Way : std::uint8_t { onward, back };

/// Which edges lead where, by car. Keeps a reference to the network.
class Reach {
  public:
    explicit Reach(const Network& network);

    /// Whether no edge leads on from it, or to it: traffic leaves or enters the network there.
    bool is_end(core::EdgeIndex edge, Way way) const;
    /// By edge: whether a car can get there from `start`, or from there to `start`; true for `start` itself.
    /// Linear in the size of the network.
    std::vector<bool> from(core::EdgeIndex start, Way way) const;

  private:
    const Network& network_;
    std::vector<std::vector<core::EdgeIndex>> predecessors_;  ///< By edge.
};

}  // namespace clearway::roads
