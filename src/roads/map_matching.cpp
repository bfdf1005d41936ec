#include "roads/map_matching.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "roads/detail/walk.hpp"

namespace clearway::roads {
namespace {

constexpr double degree_rad = std::numbers::pi / 180.0;
/// Half of a wide lane and a vehicle between two lanes.
constexpr double least_reach_m = 5.0;
/// A two-dimensional normal error is larger in one of 450 cases.
constexpr double reach_errors = 3.5;
/// A vehicle that turns or changes lanes is not parallel to its lane, and the pieces of a bend are straight.
constexpr double least_turn_rad = 45.0 * degree_rad;
constexpr double turn_errors = 3.0;
constexpr double least_sigma_m = 1.0;
constexpr double least_heading_sigma_rad = 10.0 * degree_rad;

double difference_rad(double one, double other) {
    return std::abs(std::remainder(one - other, 2.0 * std::numbers::pi));
}

double square(double value) {
    return value * value;
}

}  // namespace

MapMatcher::MapMatcher(const Network& network)
    : network_(network), grid_(network), ways_(network.lanes().size()) {
    for (std::uint32_t row = 0; row < network.lanes().size(); ++row) {
        const core::LaneIndex from{row};
        const core::EdgeIndex edge = network.lane(from).edge;
        if (network.edge(edge).internal) continue;
        for (const Connection& connection : network.connections_from(from)) {
            const core::EdgeIndex to = network.lane(connection.to).edge;
            detail::for_each_inner_lane(network, connection, [&](core::LaneIndex inner) {
                ways_[inner.value] = {edge, to};
            });
        }
    }
}

std::optional<MatchedPlace> MapMatcher::match(const Sighting& sighting, Route route) {
    assert(sighting.position_sigma_m >= 0.0 && sighting.heading_sigma_rad >= 0.0);
    const double sigma_m = sighting.position_sigma_m;
    const double most_turn_rad = least_turn_rad + turn_errors * sighting.heading_sigma_rad;
    grid_.near(sighting.point, core::Metres(least_reach_m + reach_errors * sigma_m), near_);
    std::optional<MatchedPlace> on_route, elsewhere;
    double least_on_route = std::numeric_limits<double>::infinity();
    double least_elsewhere = least_on_route;
    for (const LanePlace& place : near_) {
        const double turn_rad = difference_rad(place.heading_rad, sighting.heading_rad);
        if (turn_rad > most_turn_rad) continue;
        const double error = square(place.distance_m / std::max(sigma_m, least_sigma_m)) +
                             square(turn_rad / std::max(sighting.heading_sigma_rad, least_heading_sigma_rad));
        if (const auto route_edge = place_in(route, place.lane)) {
            if (error >= least_on_route) continue;
            least_on_route = error;
            on_route = {place.lane, place.position_m, *route_edge};
        } else if (error < least_elsewhere && is_open_road(place.lane, route)) {
            least_elsewhere = error;
            elsewhere = {place.lane, place.position_m, 0};
        }
    }
    return on_route ? on_route : elsewhere;
}

std::optional<std::uint32_t> MapMatcher::place_in(Route route, core::LaneIndex lane) const {
    const core::EdgeIndex edge = network_.lane(lane).edge;
    const bool inside = network_.edge(edge).internal;
    const Way& way = ways_[lane.value];
    for (std::uint32_t place = 0; place < route.size(); ++place) {
        const bool is_here =
            inside ? place + 1 < route.size() && route[place] == way.from && route[place + 1] == way.to
                   : route[place] == edge;
        if (is_here) return place;
    }
    return std::nullopt;
}

bool MapMatcher::is_open_road(core::LaneIndex lane, Route route) const {
    const Lane& road = network_.lane(lane);
    if (!road.allows_cars && !road.allows_emergency) return false;
    return route.empty() || !network_.edge(road.edge).internal;
}

}  // namespace clearway::roads
