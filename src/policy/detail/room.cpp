#include "policy/detail/room.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::policy::detail {
namespace {

/// Of a vehicle that is not registered, m: SUMO's default of a car.
constexpr double usual_length_m = 5.0;

}  // namespace

Room::Room(const roads::Network& network, const traffic::BelievedGraph& belief, double halted_mps)
    : network_(network) {
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
        if (!vehicle.state.lane.exists() || vehicle.state.speed_mps >= halted_mps) continue;
        const traffic::VehicleInfo* const known =
            belief.roster != nullptr ? belief.roster->find(vehicle.key) : nullptr;
        const double length_m = known != nullptr ? known->length_m : usual_length_m;
        const double rear_m = std::max(0.0, vehicle.state.lane_position_m - length_m);
        const auto [last, is_first] = rear_m_.try_emplace(vehicle.state.lane.value, rear_m);
        if (!is_first) last->second = std::min(last->second, rear_m);
    }
}

double Room::at_start_of_m(core::LaneIndex lane) const {
    assert(lane.exists());
    const auto rear = rear_m_.find(lane.value);
    return rear == rear_m_.end() ? network_.lane(lane).length_m : rear->second;
}

bool Room::is_blocked(const std::vector<roads::SignalLink>& ways, double least_m) const {
    return !ways.empty() && std::ranges::all_of(ways, [&](const roads::SignalLink& way) {
        return rear_m_.contains(way.to.value) && at_start_of_m(way.to) < least_m;
    });
}

}  // namespace clearway::policy::detail
