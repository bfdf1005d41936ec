#include "policy/detail/approach.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

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

void add_companions(const View& view, std::span<const roads::StopLine> lines, Approach& approach) {
    const roads::Signal& signal = view.network().signal(approach.signal);
    const auto link_count = static_cast<std::uint16_t>(signal.links.size());
    approach.links.reserve(approach.own_links.size() + link_count);
    approach.links = approach.own_links;
    assert(std::ranges::all_of(approach.own_links, [&](std::uint16_t own) { return own < link_count; }));
    for (std::uint16_t link = 0; link < link_count; ++link) {
        const bool on_approach = std::ranges::any_of(
            lines, [&](const roads::StopLine& line) { return starts_on(view, signal, link, line.edge); });
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
    const std::vector<roads::StopLine> lines =
        roads::signals_ahead(view.network(), view.route_of(vehicle.key), vehicle.state, horizon);
    std::vector<Approach> found;
    found.reserve(lines.size());
    for (auto first = lines.begin(); first != lines.end();) {
        const auto end = std::find_if(first, lines.end(), [&](const roads::StopLine& line) {
            return line.signal != first->signal || line.distance.value - first->distance.value >= joined_m;
        });
        Approach& approach =
            found.emplace_back(Approach{first->signal, first->distance.value, first->links, {}});
        std::vector<std::uint16_t>& own = approach.own_links;
        for (const roads::StopLine& line : std::span(first + 1, end))
            own.insert(own.end(), line.links.begin(), line.links.end());
        std::ranges::sort(own);
        add_companions(view, {first, end}, approach);
        first = end;
    }
    return found;
}

std::size_t queue_ahead(const View& view, const traffic::BelievedVehicle& vehicle, const Piece& piece,
                        double halted_mps) {
    std::vector<VehicleAhead> halted = view.vehicles_ahead(vehicle, core::Metres(piece.to_m));
    std::erase_if(halted, [&](const VehicleAhead& ahead) {
        return ahead.distance_m < piece.from_m || ahead.vehicle->state.speed_mps >= halted_mps;
    });
    // The lanes of an edge follow each other.
    const auto lane_of = [](const VehicleAhead& ahead) { return ahead.vehicle->state.lane; };
    std::ranges::sort(halted, {}, lane_of);
    std::size_t sum = 0;
    std::size_t longest = 0;
    core::EdgeIndex edge;
    for (auto at = halted.begin(); at != halted.end();) {
        const auto end = std::find_if(
            at, halted.end(), [&](const VehicleAhead& ahead) { return lane_of(ahead) != lane_of(*at); });
        const core::EdgeIndex here = view.network().lane(lane_of(*at)).edge;
        if (here != std::exchange(edge, here)) sum += std::exchange(longest, 0);
        longest = std::max(longest, static_cast<std::size_t>(end - at));
        at = end;
    }
    return sum + longest;
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
