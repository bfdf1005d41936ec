#include "roads/way_ahead.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "roads/detail/walk.hpp"

namespace clearway::roads {
namespace {

/// Edges and internal lanes of a way ahead that need one allocation.
constexpr std::size_t usually_passed = 32;
constexpr std::size_t usually_inside = 64;

}  // namespace

WayAhead::WayAhead(const Network& network, Route route, const traffic::MotionState& state,
                   core::Metres horizon)
    : network_(network), horizon_m_(horizon.value) {
    passed_.reserve(usually_passed);
    inside_.reserve(usually_inside);
    detail::Walk walk(network, route, state);
    std::uint32_t step = 0;
    do {
        const core::EdgeIndex here = network.lane(walk.lane()).edge;
        passed_.push_back({here, step, walk.start_m()});
        if (!walk.inside_junction() && walk.route_edge() + 1 < route.size())
            add_junction(here, route[walk.route_edge() + 1], step, walk.end_m());
        ++step;
    } while (walk.end_m() <= horizon_m_ && walk.next());
    std::ranges::sort(passed_, {}, [](const Passed& one) { return std::pair(one.edge, one.step); });
    std::ranges::sort(inside_, {},
                      [](const Inside& one) { return std::tuple(one.lane, one.step, one.way_m); });
}

void WayAhead::add_junction(core::EdgeIndex from, core::EdgeIndex to, std::uint32_t step, double junction_m) {
    const Edge& edge = network_.edge(from);
    for (std::uint32_t row = edge.first_lane; row < edge.first_lane + edge.lane_count; ++row) {
        for (const Connection& connection : network_.connections_from(core::LaneIndex{row})) {
            if (network_.lane(connection.to).edge != to) continue;
            double way_m = 0.0;
            detail::for_each_inner_lane(network_, connection, [&](core::LaneIndex inner) {
                inside_.push_back({inner, step, junction_m, way_m});
                way_m += network_.lane(inner).length_m;
            });
        }
    }
}

std::optional<core::Metres> WayAhead::within(double distance_m) const {
    if (distance_m < 0.0 || distance_m > horizon_m_) return std::nullopt;
    return core::Metres(distance_m);
}

std::optional<core::Metres> WayAhead::distance_to(const traffic::MotionState& other) const {
    if (!other.lane.exists()) return std::nullopt;
    const core::EdgeIndex wanted = network_.lane(other.lane).edge;
    auto inside = inside_.end();
    if (network_.edge(wanted).internal) {
        inside = std::ranges::lower_bound(inside_, other.lane, {}, &Inside::lane);
        if (inside != inside_.end() && inside->lane != other.lane) inside = inside_.end();
    }
    for (auto passed = std::ranges::lower_bound(passed_, wanted, {}, &Passed::edge);
         passed != passed_.end() && passed->edge == wanted; ++passed) {
        if (inside != inside_.end() && inside->step < passed->step) break;
        if (const auto distance = within(passed->start_m + other.lane_position_m)) return distance;
    }
    if (inside == inside_.end()) return std::nullopt;
    return within(inside->junction_m + (inside->way_m + other.lane_position_m));
}

}  // namespace clearway::roads
