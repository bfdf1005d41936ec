#include "policy/detail/approach.hpp"

#include <algorithm>
#include <cassert>
#include <map>

namespace clearway::policy::detail {
namespace {

/// Stop lines of one signal farther apart than this are separate approaches, m. Joined junctions are smaller.
constexpr double joined_m = 150.0;
/// Lower bound for speeds in travel times, m/s: a lane may state a limit near 0.
constexpr double slowest_mps = 1.0;

bool starts_on(const View& view, const roads::Signal& signal, std::size_t link, core::EdgeIndex edge) {
    return std::ranges::any_of(signal.links[link], [&](const roads::SignalLink& way) {
        return view.network().lane(way.from).edge == edge;
    });
}

void add_companions(const View& view, const std::vector<core::EdgeIndex>& edges, Approach& approach) {
    const roads::Signal& signal = view.network().signal(approach.signal);
    approach.links = approach.own_links;
    const auto link_count = static_cast<std::uint16_t>(signal.links.size());
    assert(std::ranges::all_of(approach.own_links, [&](std::uint16_t own) { return own < link_count; }));
    for (std::uint16_t link = 0; link < link_count; ++link) {
        const bool on_approach = std::ranges::any_of(
            edges, [&](core::EdgeIndex edge) { return starts_on(view, signal, link, edge); });
        const bool crosses = std::ranges::any_of(approach.own_links, [&](std::uint16_t own) {
            return signal.foes[link][own] || signal.foes[own][link];
        });
        if (on_approach && !crosses) approach.links.push_back(link);
    }
    std::ranges::sort(approach.links);
    approach.links.erase(std::unique(approach.links.begin(), approach.links.end()), approach.links.end());
}

}  // namespace

std::vector<Approach> approaches(const View& view, const traffic::BelievedVehicle& vehicle,
                                 core::Metres horizon) {
    assert(view.is_on_route(vehicle));
    std::vector<Approach> found;
    std::vector<std::vector<core::EdgeIndex>> edges;
    for (const roads::StopLine& line :
         roads::signals_ahead(view.network(), view.route_of(vehicle.key), vehicle.state, horizon)) {
        if (line.links.empty()) continue;
        const bool joined = !found.empty() && found.back().signal == line.signal &&
                            line.distance.value - found.back().distance_m < joined_m;
        if (!joined) {
            found.push_back({line.signal, line.distance.value, {}, {}});
            edges.emplace_back();
        }
        std::vector<std::uint16_t>& own = found.back().own_links;
        own.insert(own.end(), line.links.begin(), line.links.end());
        edges.back().push_back(line.edge);
    }
    for (std::size_t row = 0; row < found.size(); ++row) {
        std::ranges::sort(found[row].own_links);
        add_companions(view, edges[row], found[row]);
    }
    return found;
}

std::size_t queue_ahead(const View& view, const traffic::BelievedVehicle& vehicle, const Piece& piece,
                        double halted_mps) {
    std::map<core::LaneIndex, std::size_t> by_lane;
    for (const VehicleAhead& ahead : view.vehicles_ahead(vehicle, core::Metres(piece.to_m))) {
        if (ahead.distance_m >= piece.from_m && ahead.vehicle->state.speed_mps < halted_mps)
            ++by_lane[ahead.vehicle->state.lane];
    }
    std::map<core::EdgeIndex, std::size_t> by_edge;
    for (const auto& [lane, count] : by_lane) {
        std::size_t& longest = by_edge[view.network().lane(lane).edge];
        longest = std::max(longest, count);
    }
    std::size_t sum = 0;
    for (const auto& [edge, count] : by_edge)
        sum += count;
    return sum;
}

double free_travel_time_s(const View& view, const traffic::BelievedVehicle& vehicle, double distance_m) {
    assert(vehicle.state.lane.exists());
    const roads::Route route = view.route_of(vehicle.key);
    traffic::BelievedVehicle there = vehicle;
    double time_s = 0.0;
    double left_m = distance_m;
    for (std::size_t row = vehicle.state.route_edge; row < route.size() && left_m > 0.0; ++row) {
        const roads::Edge& edge = view.network().edge(route[row]);
        const bool is_here = row == vehicle.state.route_edge;
        const roads::Lane& lane = view.network().lane(vehicle.state.lane);
        const double rest_m =
            is_here ? std::max(0.0F, lane.length_m - vehicle.state.lane_position_m) : edge.length_m;
        there.state.lane = is_here ? vehicle.state.lane : view.network().lane_of(route[row], 0);
        const double piece_m = row + 1 == route.size() ? left_m : std::min(left_m, rest_m);
        time_s += piece_m / std::max(view.allowed_speed(there).value, slowest_mps);
        left_m -= piece_m;
    }
    return time_s;
}

}  // namespace clearway::policy::detail
