#pragma once

#include <cstdint>

#include "roads/network.hpp"
#include "roads/route.hpp"

namespace clearway::roads::detail {

/// The lanes that a vehicle passes when it follows its route from its present place: it stays on its lane as
/// long as that continues, and otherwise takes the nearest lane that does (of two, the one with the lower
/// number).
class Walk {
  public:
    /// Throws std::invalid_argument when `state` has no lane or its `route_edge` is outside the route.
    Walk(const Network& network, Route route, const traffic::MotionState& state);

    core::LaneIndex lane() const { return lane_; }
    /// Position in the route of the last edge outside junctions that was entered.
    std::uint32_t route_edge() const { return route_edge_; }
    /// Whether the present lane is inside a junction.
    bool inside_junction() const;
    /// Distance from the vehicle's place to the start of the present lane, m; negative on the first one.
    double start_m() const { return start_m_; }
    double end_m() const { return start_m_ + network_.lane(lane_).length_m; }
    /// The connection that `next` takes; null at the end of the route.
    const Connection* onward() const;
    /// Moves to the next lane. Returns false, without moving, at the end of the route.
    bool next();

  private:
    const Network& network_;
    Route route_;
    core::LaneIndex lane_;
    std::uint32_t route_edge_;
    double start_m_;
};

/// The connection from `lane` to `next`; of several, the first that continues to `after_next` (which may be
/// none). Null when there is no connection.
const Connection* connection_to(const Network& network, core::LaneIndex lane, core::EdgeIndex next,
                                core::EdgeIndex after_next);

/// Calls `visit(lane)` with each lane of the way through the junction that `connection` takes, in order.
template <class Visitor>
void for_each_inner_lane(const Network& network, const Connection& connection, const Visitor& visit) {
    constexpr int most_lanes = 16;  // Against cyclic files; netconvert writes 1 or 2.
    core::LaneIndex lane = connection.via;
    for (int count = 0; lane.exists() && count < most_lanes; ++count) {
        visit(lane);
        const auto onward = network.connections_from(lane);
        lane = onward.empty() ? core::LaneIndex::none() : onward.front().via;
    }
}

}  // namespace clearway::roads::detail
