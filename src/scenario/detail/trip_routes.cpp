#include "scenario/detail/trip_routes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "roads/route.hpp"

namespace clearway::scenario::detail {
namespace {

using Edges = std::vector<core::EdgeIndex>;

/// Weight of each edge: its share of the total length, plus, at an end of the network, its share of the lanes
/// there.
std::vector<double> weights(const roads::Network& network, const roads::Reach& reach, const Edges& edges,
                            roads::Way way) {
    double length_m = 0.0;
    double lanes = 0.0;
    for (const core::EdgeIndex edge : edges) {
        length_m += network.edge(edge).length_m;
        if (reach.is_end(edge, way)) lanes += network.edge(edge).lane_count;
    }
    std::vector<double> result;
    result.reserve(edges.size());
    for (const core::EdgeIndex edge : edges)
        result.push_back(network.edge(edge).length_m / length_m +
                         (reach.is_end(edge, way) ? network.edge(edge).lane_count / lanes : 0.0));
    return result;
}

/// Draws an edge by weight among those for which `may_be_drawn` holds; `none` if there is none.
template <class MayBeDrawn>
core::EdgeIndex pick(const Edges& edges, const std::vector<double>& weight, double uniform,
                     const MayBeDrawn& may_be_drawn) {
    double sum = 0.0;
    for (std::size_t row = 0; row < edges.size(); ++row)
        if (may_be_drawn(edges[row])) sum += weight[row];
    double left = uniform * sum;
    core::EdgeIndex drawn;
    for (std::size_t row = 0; row < edges.size(); ++row) {
        if (!may_be_drawn(edges[row])) continue;
        drawn = edges[row];
        if (left < weight[row]) break;
        left -= weight[row];
    }
    return drawn;
}

using core::Purpose;
using roads::Way;

/// Numbers of the random draws for one vehicle; from `first_trip` on, origins and destinations alternate.
/// Never renumber them.
enum TripDraw : std::uint64_t { leg = 2, first_trip = 16 };

constexpr std::uint64_t most_draws = 1000;

/// Whether a route makes a U-turn somewhere.
bool turns_round(const roads::Network& network, const RouteEdges& route) {
    for (std::size_t row = 0; row + 1 < route.size(); ++row) {
        const roads::Edge& edge = network.edge(route[row]);
        for (std::uint32_t lane = 0; lane < edge.lane_count; ++lane)
            for (const roads::Connection& way : network.connections_from(network.lane_of(route[row], lane)))
                if (way.direction == 't' && network.lane(way.to).edge == route[row + 1]) return true;
    }
    return false;
}

/// Whether a vehicle of class `emergency` can get from an edge to the next.
bool leads_emergency(const roads::Network& network, core::EdgeIndex from, core::EdgeIndex to) {
    const roads::Edge& edge = network.edge(from);
    for (std::uint32_t lane = 0; lane < edge.lane_count; ++lane)
        for (const roads::Connection& way : network.connections_from(network.lane_of(from, lane)))
            if (way.allows_emergency && network.lane(way.to).edge == to) return true;
    return false;
}

}  // namespace

ReachableEnds::ReachableEnds(const roads::Network& network, Edges edges)
    : reach_(network),
      edges_(std::move(edges)),
      from_weight_(weights(network, reach_, edges_, roads::Way::back)),
      to_weight_(weights(network, reach_, edges_, roads::Way::onward)) {}

core::EdgeIndex ReachableEnds::origin(double uniform) const {
    return pick(edges_, from_weight_, uniform, [](core::EdgeIndex) { return true; });
}

core::EdgeIndex ReachableEnds::other_end(core::EdgeIndex end, roads::Way way, double uniform) const {
    const std::vector<bool> reached = reach_.from(end, way);
    return pick(edges_, way == roads::Way::onward ? to_weight_ : from_weight_, uniform,
                [&](core::EdgeIndex edge) { return reached[edge.value] && edge != end; });
}

bool open_to_emergency(const roads::Network& network, const RouteEdges& route) {
    const auto lanes_of = [&](core::EdgeIndex edge) {
        return network.lanes().subspan(network.edge(edge).first_lane, network.edge(edge).lane_count);
    };
    for (std::size_t row = 0; row < route.size(); ++row) {
        if (std::ranges::none_of(lanes_of(route[row]), &roads::Lane::allows_emergency)) return false;
        if (row + 1 < route.size() && !leads_emergency(network, route[row], route[row + 1])) return false;
    }
    return true;
}

TripRoutes::TripRoutes(const DemandContext& context) : context_(context), fastest_(context.network) {
    edges_ = trip_edges(context.network, context.config.trips);
    for (const core::EdgeIndex edge : edges_)
        reached_m_.push_back((reached_m_.empty() ? 0.0 : reached_m_.back()) +
                             context.network.edge(edge).length_m);
    if (edges_.empty())
        throw core::InputError(core::Problem{context.config.where("trips.minimum_edge_m"),
                                             "leaves no edge for trips to start and end on",
                                             "shorter than the longest edge", "lower it"});
    if (context.config.trips.ends == TripEnds::reachable) reachable_.emplace(context.network, edges_);
    read_sites();
}

void TripRoutes::read_sites() {
    std::vector<core::Problem> problems;
    const std::vector<core::EdgeIndex> edges = site_edges(context_.config, context_.network, problems);
    if (!problems.empty()) throw core::InputError(std::move(problems));
    for (std::size_t row = 0; row < edges.size(); ++row) {
        const SiteKind kind = context_.config.emergency_sites[row].kind;
        (kind == SiteKind::hospital ? hospitals_ : stations_).push_back(edges[row]);
        if (kind == SiteKind::fire_station) fire_stations_.push_back(edges[row]);
    }
    if (stations_.empty()) stations_ = hospitals_;
    if (hospitals_.empty()) hospitals_ = stations_;
    if (fire_stations_.empty()) fire_stations_ = stations_;
}

template <class DrawEnds>
RouteEdges TripRoutes::search(const LeastLength& least, bool for_emergency, const DrawEnds& draw) {
    const roads::Network& network = context_.network;
    for (std::uint64_t attempt = 0; attempt < most_draws; ++attempt) {
        const Ends ends = draw(TripDraw::first_trip + 2 * attempt);
        if (!ends.from.exists() || !ends.to.exists() || too_far(ends)) continue;
        auto route = fastest_.between(ends.from, ends.to);
        if (route && roads::route_length(network, *route).value >= least.metres &&
            !turns_round(network, *route) && (!for_emergency || open_to_emergency(network, *route)))
            return *std::move(route);
    }
    throw core::InputError(
        core::Problem{context_.config.where(least.key),
                      fmt::format("no trip of {} m or more in {} draws", least.metres, most_draws),
                      "shorter trips", "lower it"});
}

RouteEdges TripRoutes::traffic(const std::string& id) {
    return search({"trips.minimum_length_m", context_.config.trips.minimum_length_m}, false,
                  [&](std::uint64_t counter) { return two_places(Purpose::demand, id, counter); });
}

RouteEdges TripRoutes::emergency(const std::string& id, traffic::VehicleKind kind, const LeastLength& least) {
    if (stations_.empty())
        return search(least, true,
                      [&](std::uint64_t counter) { return two_places(Purpose::emergency, id, counter); });
    const bool is_fire_engine = kind == traffic::VehicleKind::fire_engine;
    const auto& stations = is_fire_engine ? fire_stations_ : stations_;
    const bool to_hospital =
        !is_fire_engine &&
        context_.random.uniform(Purpose::emergency, core::vehicle_key(id).value, TripDraw::leg) >= 0.5;
    return search(least, true, [&](std::uint64_t counter) {
        if (to_hospital) {
            const core::EdgeIndex to = site(hospitals_, id, counter + 1);
            return Ends{other_place(to, Way::back, {Purpose::emergency, id, counter}), to};
        }
        const core::EdgeIndex from = site(stations, id, counter);
        return Ends{from, other_place(from, Way::onward, {Purpose::emergency, id, counter + 1})};
    });
}

TripRoutes::Ends TripRoutes::two_places(Purpose purpose, const std::string& id, std::uint64_t counter) const {
    const Draw first{purpose, id, counter};
    const core::EdgeIndex from = reachable_ ? reachable_->origin(uniform(first)) : place(first);
    return {from, other_place(from, Way::onward, {purpose, id, counter + 1})};
}

core::EdgeIndex TripRoutes::other_place(core::EdgeIndex end, Way way, const Draw& draw) const {
    return reachable_ ? reachable_->other_end(end, way, uniform(draw)) : place(draw);
}

double TripRoutes::uniform(const Draw& draw) const {
    return context_.random.uniform(draw.purpose, core::vehicle_key(draw.id).value, draw.counter);
}

core::EdgeIndex TripRoutes::place(const Draw& draw) const {
    const double at_m = uniform(draw) * reached_m_.back();
    const auto row = std::upper_bound(reached_m_.begin(), reached_m_.end(), at_m) - reached_m_.begin();
    return edges_[std::min<std::size_t>(row, edges_.size() - 1)];
}

core::EdgeIndex TripRoutes::site(const std::vector<core::EdgeIndex>& sites, const std::string& id,
                                 std::uint64_t counter) const {
    return sites[context_.random.below(sites.size(), Purpose::emergency, core::vehicle_key(id).value,
                                       counter)];
}

bool TripRoutes::too_far(const Ends& ends) const {
    const std::optional<double>& limit_m = context_.config.trips.maximum_distance_m;
    if (!limit_m) return false;
    const auto start = [&](core::EdgeIndex edge) {
        return context_.network.lane(context_.network.lane_of(edge, 0)).shape.front();
    };
    const roads::Point from = start(ends.from);
    const roads::Point to = start(ends.to);
    return std::hypot(from.x_m - to.x_m, from.y_m - to.y_m) > *limit_m;
}

}  // namespace clearway::scenario::detail
