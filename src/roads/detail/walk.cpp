#include "roads/detail/walk.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <stdexcept>

namespace clearway::roads::detail {
namespace {

bool leads_to(const Network& network, core::LaneIndex lane, core::EdgeIndex edge) {
    const std::span<const Connection> ways = network.connections_from(lane);
    return std::any_of(ways.begin(), ways.end(), [&](const Connection& connection) {
        return network.lane(connection.to).edge == edge;
    });
}

core::EdgeIndex edge_at(Route route, std::size_t place) {
    return place < route.size() ? route[place] : core::EdgeIndex::none();
}

/// The connection to `next` from the nearest lane on the edge of `lane` that has one.
const Connection* nearest_connection(const Network& network, core::LaneIndex lane, core::EdgeIndex next,
                                     core::EdgeIndex after_next) {
    const Edge& edge = network.edge(network.lane(lane).edge);
    const int own = static_cast<int>(network.lane(lane).number);
    const int count = static_cast<int>(edge.lane_count);
    assert(own < count);
    for (int away = 0; away < count; ++away) {
        for (const int number : {own - away, own + away}) {
            if (number < 0 || number >= count) continue;
            const core::LaneIndex candidate{edge.first_lane + static_cast<std::uint32_t>(number)};
            const Connection* found = connection_to(network, candidate, next, after_next);
            if (found != nullptr) return found;
        }
    }
    return nullptr;
}

}  // namespace

const Connection* connection_to(const Network& network, core::LaneIndex lane, core::EdgeIndex next,
                                core::EdgeIndex after_next) {
    const Connection* first = nullptr;
    for (const Connection& connection : network.connections_from(lane)) {
        if (network.lane(connection.to).edge != next) continue;
        if (first == nullptr) first = &connection;
        if (after_next.exists() && leads_to(network, connection.to, after_next)) return &connection;
    }
    return first;
}

Walk::Walk(const Network& network, Route route, const traffic::MotionState& state)
    : network_(network),
      route_(route),
      lane_(state.lane),
      route_edge_(state.route_edge),
      start_m_(-static_cast<double>(state.lane_position_m)) {
    if (!state.lane.exists()) throw std::invalid_argument("the state has no lane");
    if (state.route_edge >= route.size()) throw std::invalid_argument("the state is outside its route");
}

bool Walk::inside_junction() const {
    return network_.edge(network_.lane(lane_).edge).internal;
}

const Connection* Walk::onward() const {
    if (inside_junction()) {
        const auto connections = network_.connections_from(lane_);
        return connections.empty() ? nullptr : &connections.front();
    }
    const core::EdgeIndex next = edge_at(route_, route_edge_ + 1);
    if (!next.exists()) return nullptr;
    return nearest_connection(network_, lane_, next, edge_at(route_, route_edge_ + 2));
}

bool Walk::next() {
    const Connection* connection = onward();
    if (connection == nullptr) return false;
    const bool enters_edge = !connection->via.exists();
    if (enters_edge && route_edge_ + 1 >= route_.size()) return false;
    start_m_ = end_m();
    lane_ = enters_edge ? connection->to : connection->via;
    if (enters_edge) ++route_edge_;
    assert(route_edge_ < route_.size());
    return true;
}

}  // namespace clearway::roads::detail
