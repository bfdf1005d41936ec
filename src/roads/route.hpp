#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/observation.hpp"

namespace clearway::roads {

// Functions that take a route and a state expect `state.route_edge` within the route and `state.lane` to
// exist (on that edge, or inside the junction behind it); they throw std::invalid_argument otherwise. They
// walk the lanes as `advance` says, so their answers agree with each other. A route whose edges are not
// connected ends at the gap. Cost: linear in the lanes passed; no allocation unless stated.

/// Edges in driving order, internal edges left out: what a navigation system knows.
using Route = std::span<const core::EdgeIndex>;

/// Length of a route from the start of its first edge to the end of its last one, ways across junctions
/// included, 0 for the empty route.
core::Metres route_length(const Network& network, Route route);

/// Where a vehicle is after driving `distance` further along its route from `state`, staying on its lane as
/// long as the lane continues and otherwise taking the nearest lane that does. Internal lanes count. Stops at
/// the end of the route; `past_end` is the distance left over. Throws std::invalid_argument for a negative
/// `distance`.
struct Advanced {
    traffic::MotionState state;  ///< Speed is copied from the start.
    core::Metres past_end{0.0};
};
Advanced advance(const Network& network, Route route, const traffic::MotionState& state,
                 core::Metres distance);

/// One lane of the way ahead.
struct RouteStep {
    core::LaneIndex lane;
    float start_m = 0.0F;  ///< From the vehicle's place to the start of the lane; negative on the first one.
    float end_m = 0.0F;
    std::uint32_t route_edge = 0;
    /// Signal of the connection taken at the end of the lane; none if it has no signal or the route ends.
    core::SignalIndex signal;
    std::uint16_t signal_link = 0;
};
/// The lanes that `advance` would pass on the first `horizon` metres, in order; `steps` is reused. Returns
/// whether the route continues after the last of them.
bool lanes_ahead(const Network& network, Route route, const traffic::MotionState& state, core::Metres horizon,
                 std::vector<RouteStep>& steps);

/// Distance along the route from `state` to the end of the route.
core::Metres distance_to_end(const Network& network, Route route, const traffic::MotionState& state);

/// Distance along `route` from `state` (on it) to another vehicle's place, when that place lies on the same
/// edges ahead, within `horizon`; internal lanes of junctions that the route passes count as on it. 0 when
/// the two are level on one edge; nothing when the other is not ahead or has no lane.
std::optional<core::Metres> distance_ahead(const Network& network, Route route,
                                           const traffic::MotionState& state,
                                           const traffic::MotionState& other, core::Metres horizon);

/// A stop line ahead on a route.
struct StopLine {
    core::SignalIndex signal;  ///< None for a junction without signal (not listed by signals_ahead).
    core::EdgeIndex edge;      ///< The edge that ends there.
    core::EdgeIndex next_edge;
    /// Links of the signal from any lane of `edge` to `next_edge`, ascending.
    std::vector<std::uint16_t> links;
    core::Metres distance{0.0};  ///< Along the route from the vehicle's front.
};
/// Signals ahead within `horizon`, nearest first. Allocates.
std::vector<StopLine> signals_ahead(const Network& network, Route route, const traffic::MotionState& state,
                                    core::Metres horizon);

/// A lane that is not among the best for a route is worth taking when it can be followed for longer than this
/// (found in first trials: with shorter distances, vehicles get stuck before turns).
inline constexpr core::Metres worth_following{300.0};

/// How far a vehicle at `lane_position` on `lane` (on route[route_edge]) can follow `route` without a lane
/// change: at most to the end of the route, and at most `horizon`.
core::Metres drivable(const Network& network, Route route, std::uint32_t route_edge, core::LaneIndex lane,
                      core::Metres lane_position, core::Metres horizon);

}  // namespace clearway::roads
