#include "loop/way_trials.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "loop/closed_loop.hpp"
#include "loop/copy_of_run.hpp"

namespace clearway::loop {
namespace {

/// Ways that are longer than the fastest by more than this, by free flow, are not tried.
constexpr double longest_share = 2.0;
constexpr double longest_extra_s = 60.0;

}  // namespace

WayTrials::WayTrials(const roads::Network& network, const experiment::LoopConfig& config,
                     std::filesystem::path folder)
    : network_(network),
      config_(config),
      folder_(std::move(folder)),
      search_(network, roads::Driver::emergency) {}

void WayTrials::look(ClosedLoop& loop, core::Seconds horizon) {
    const truth::Snapshot& snapshot = loop.snapshot();
    const double now_s = snapshot.time.value;
    trials_.note(loop.events());
    for (std::uint32_t row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != traffic::VehicleClass::emergency) continue;
        double& next_s = next_s_.try_emplace(snapshot.key[row], now_s).first->second;
        if (now_s + core::clock_tolerance_s < next_s) continue;
        if (network_.edge(network_.lane(snapshot.lane[row]).edge).internal) continue;
        next_s = now_s + config_.ways_every_s;
        try_ways(loop, row, horizon);
    }
}

void WayTrials::try_ways(ClosedLoop& loop, std::uint32_t row, core::Seconds horizon) {
    const truth::Snapshot& snapshot = loop.snapshot();
    const core::VehicleKey vehicle = snapshot.key[row];
    const traffic::VehicleInfo& info = *loop.roster().find(vehicle);
    const std::vector<core::EdgeIndex> route = loop.roster().route(info.route);
    const std::size_t at = snapshot.route_edge[row];
    const roads::Lane& lane = network_.lane(snapshot.lane[row]);
    const double braking_m =
        snapshot.speed_mps[row] * snapshot.speed_mps[row] / (2.0 * info.deceleration_mps2);
    const bool turns_here = lane.length_m - snapshot.lane_position_m[row] > braking_m + roads::turn_room_m;
    const std::size_t fork = turns_here ? at : at + 1;
    if (fork + 1 >= route.size() || roads::passes_its_end(std::span(route).subspan(at))) return;
    const auto free = [&](core::EdgeIndex edge, double) { return search_.free_s(edge); };
    auto ways = search_.ways({route[fork], route.back()}, free, static_cast<std::size_t>(config_.ways_tried));
    if (ways.empty()) return;
    const double least_s = search_.time_of(ways.front(), 0.0, free);
    std::erase_if(ways, [&](const auto& way) {
        return search_.time_of(way, 0.0, free) > longest_share * least_s + longest_extra_s;
    });
    if (ways.size() < 2) return;
    const std::vector<core::EdgeIndex>* best = nullptr;
    double best_s = std::numeric_limits<double>::infinity();
    for (std::vector<core::EdgeIndex>& way : ways) {
        if (fork > at) way.insert(way.begin(), route[at]);
        const double way_s = arrival_s(loop, vehicle, horizon, [&] { return loop.keep_to({vehicle, way}); });
        if (way_s >= best_s) continue;
        best_s = way_s;
        best = &way;
    }
    trials_.add({vehicle}, {best_s}, ways.size());
    if (config_.best_way_taken == 0 || best == nullptr) return;
    const double unchanged_s = arrival_s(loop, vehicle, horizon, [] { return true; });
    if (best_s < unchanged_s) loop.keep_to({vehicle, *best});
}

double WayTrials::arrival_s(ClosedLoop& loop, core::VehicleKey vehicle, core::Seconds horizon,
                            const std::function<bool()>& change) {
    return in_copy(folder_, [&] { return loop.end_after(change, vehicle, horizon, folder_); }).arrival.value;
}

}  // namespace clearway::loop
