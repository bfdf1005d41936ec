#include "roads/route.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "roads/detail/walk.hpp"

namespace clearway::roads {
namespace {

using detail::Walk;

/// What a way ahead usually has at most, so that it needs one allocation.
constexpr std::size_t usual_steps = 32;
constexpr std::size_t usual_lines = 8;

traffic::MotionState place_on(const Network& network, const Walk& walk, double position_m, float speed_mps) {
    const core::Metres position(position_m);
    const Point point = network.point_at(walk.lane(), position);
    return {.x_m = point.x_m,
            .y_m = point.y_m,
            .heading_rad = static_cast<float>(network.heading_at(walk.lane(), position)),
            .speed_mps = speed_mps,
            .lane = walk.lane(),
            .lane_position_m = static_cast<float>(position_m),
            .route_edge = walk.route_edge()};
}

/// Distance along the way across a junction, from the end of edge `from` towards `to`, up to `position_m` on
/// `lane`.
std::optional<double> distance_into_junction(const Network& network, core::EdgeIndex from, core::EdgeIndex to,
                                             core::LaneIndex lane, double position_m) {
    const Edge& edge = network.edge(from);
    std::optional<double> found;
    for (std::uint32_t row = edge.first_lane; row < edge.first_lane + edge.lane_count; ++row) {
        for (const Connection& connection : network.connections_from(core::LaneIndex{row})) {
            if (network.lane(connection.to).edge != to) continue;
            double passed_m = 0.0;
            detail::for_each_inner_lane(network, connection, [&](core::LaneIndex inner) {
                if (inner == lane) found = passed_m + position_m;
                passed_m += network.lane(inner).length_m;
            });
            if (found) return found;
        }
    }
    return found;
}

std::vector<std::uint16_t> links_between(const Network& network, core::EdgeIndex from, core::EdgeIndex to,
                                         core::SignalIndex& signal) {
    std::vector<std::uint16_t> links;
    const Edge& edge = network.edge(from);
    for (std::uint32_t row = edge.first_lane; row < edge.first_lane + edge.lane_count; ++row) {
        for (const Connection& connection : network.connections_from(core::LaneIndex{row})) {
            if (network.lane(connection.to).edge != to || !connection.signal.exists()) continue;
            signal = connection.signal;
            if (links.empty()) links.reserve(edge.lane_count);
            links.push_back(connection.signal_link);
        }
    }
    std::ranges::sort(links);
    links.erase(std::unique(links.begin(), links.end()), links.end());
    return links;
}

/// Follows a route without lane changes from `lane` on route[route_edge]; the longest of the ways counts.
double drivable_from(const Network& network, Route route, std::uint32_t route_edge, core::LaneIndex lane,
                     double horizon_m) {
    assert(route_edge < route.size());
    const double length_m = network.lane(lane).length_m;
    if (length_m >= horizon_m || route_edge + 1 >= route.size()) return length_m;
    double onward_m = 0.0;
    for (const Connection& connection : network.connections_from(lane)) {
        if (network.lane(connection.to).edge != route[route_edge + 1]) continue;
        double way_m = 0.0;
        detail::for_each_inner_lane(network, connection,
                                    [&](core::LaneIndex inner) { way_m += network.lane(inner).length_m; });
        way_m += drivable_from(network, route, route_edge + 1, connection.to, horizon_m - length_m - way_m);
        onward_m = std::max(onward_m, way_m);
    }
    return length_m + onward_m;
}

}  // namespace

core::Metres route_length(const Network& network, Route route) {
    if (route.empty()) return core::Metres(0.0);
    return distance_to_end(network, route, {.lane = network.lane_of(route.front(), 0)});
}

Advanced advance(const Network& network, Route route, const traffic::MotionState& state,
                 core::Metres distance) {
    if (!(distance.value >= 0.0)) throw std::invalid_argument("advance by a negative distance");
    Walk walk(network, route, state);
    if (distance.value == 0.0) return {state};
    while (distance.value > walk.end_m()) {
        if (walk.next()) continue;
        const double past_end_m = distance.value - walk.end_m();
        return {place_on(network, walk, network.lane(walk.lane()).length_m, state.speed_mps),
                core::Metres(past_end_m)};
    }
    return {place_on(network, walk, distance.value - walk.start_m(), state.speed_mps)};
}

bool lanes_ahead(const Network& network, Route route, const traffic::MotionState& state, core::Metres horizon,
                 std::vector<RouteStep>& steps) {
    steps.clear();
    steps.reserve(usual_steps);
    Walk walk(network, route, state);
    for (;;) {
        RouteStep& step = steps.emplace_back();
        step.lane = walk.lane();
        step.start_m = static_cast<float>(walk.start_m());
        step.end_m = static_cast<float>(walk.end_m());
        assert(step.start_m <= step.end_m);
        step.route_edge = walk.route_edge();
        const Connection* const onward = walk.onward();
        if (onward == nullptr) return false;
        step.signal = onward->signal;
        step.signal_link = onward->signal_link;
        if (walk.end_m() > horizon.value) return true;
        if (!walk.next()) return false;
    }
}

core::Metres distance_to_end(const Network& network, Route route, const traffic::MotionState& state) {
    Walk walk(network, route, state);
    while (walk.next()) {
    }
    return core::Metres(std::max(0.0, walk.end_m()));
}

std::optional<core::Metres> distance_ahead(const Network& network, Route route,
                                           const traffic::MotionState& state,
                                           const traffic::MotionState& other, core::Metres horizon) {
    if (!other.lane.exists()) return std::nullopt;
    const core::EdgeIndex wanted = network.lane(other.lane).edge;
    const bool in_junction = network.edge(wanted).internal;
    Walk walk(network, route, state);
    const auto within = [&](double distance_m) -> std::optional<core::Metres> {
        if (distance_m < 0.0 || distance_m > horizon.value) return std::nullopt;
        return core::Metres(distance_m);
    };
    do {
        const core::EdgeIndex here = network.lane(walk.lane()).edge;
        if (here == wanted) {
            const auto distance = within(walk.start_m() + other.lane_position_m);
            if (distance) return distance;
        }
        if (in_junction && !walk.inside_junction() && walk.route_edge() + 1 < route.size()) {
            const auto inside = distance_into_junction(network, here, route[walk.route_edge() + 1],
                                                       other.lane, other.lane_position_m);
            if (inside) return within(walk.end_m() + *inside);
        }
    } while (walk.end_m() <= horizon.value && walk.next());
    return std::nullopt;
}

std::vector<StopLine> signals_ahead(const Network& network, Route route, const traffic::MotionState& state,
                                    core::Metres horizon) {
    std::vector<StopLine> lines;
    lines.reserve(usual_lines);
    Walk walk(network, route, state);
    do {
        if (walk.inside_junction() || walk.route_edge() + 1 >= route.size()) continue;
        if (walk.end_m() > horizon.value) break;
        StopLine line;
        line.edge = network.lane(walk.lane()).edge;
        line.next_edge = route[walk.route_edge() + 1];
        line.distance = core::Metres(std::max(0.0, walk.end_m()));
        line.links = links_between(network, line.edge, line.next_edge, line.signal);
        if (line.signal.exists()) lines.push_back(std::move(line));
    } while (walk.next());
    return lines;
}

// Six parameters; the public header explains each.
// NOLINTNEXTLINE(readability-function-size)
core::Metres drivable(const Network& network, Route route, std::uint32_t route_edge, core::LaneIndex lane,
                      core::Metres lane_position, core::Metres horizon) {
    if (!lane.exists()) throw std::invalid_argument("no lane");
    if (route_edge >= route.size()) throw std::invalid_argument("the lane is outside the route");
    const double whole_m =
        drivable_from(network, route, route_edge, lane, horizon.value + lane_position.value);
    return core::Metres(std::clamp(whole_m - lane_position.value, 0.0, horizon.value));
}

}  // namespace clearway::roads
