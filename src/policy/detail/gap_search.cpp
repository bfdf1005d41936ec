#include "policy/detail/gap_search.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace clearway::policy::detail {

namespace {

/// Vehicles on a lane, rearmost first. `own` is left out, because the belief about it may lag behind.
std::vector<const traffic::BelievedVehicle*> vehicles_on(const View& view, core::LaneIndex lane,
                                                         core::VehicleKey own) {
    std::vector<const traffic::BelievedVehicle*> on_lane;
    for (const traffic::BelievedVehicle& vehicle : view.belief().vehicles)
        if (vehicle.state.lane == lane && vehicle.key != own) on_lane.push_back(&vehicle);
    std::ranges::sort(on_lane, {}, [](const auto* vehicle) { return vehicle->state.lane_position_m; });
    return on_lane;
}

}  // namespace

std::optional<Gap> nearest_gap(const View& view, const traffic::BelievedVehicle& vehicle,
                               core::LaneIndex lane, const Headways& headways) {
    assert(lane.exists() && lane != vehicle.state.lane);
    const std::vector<const traffic::BelievedVehicle*> on_lane = vehicles_on(view, lane, vehicle.key);
    if (on_lane.empty()) return Gap{};
    const traffic::VehicleInfo& own = view.info_of(vehicle);
    std::optional<Gap> best;
    for (std::size_t row = 0; row <= on_lane.size(); ++row) {
        const traffic::BelievedVehicle* const behind = row > 0 ? on_lane[row - 1] : nullptr;
        const traffic::BelievedVehicle* const before = row < on_lane.size() ? on_lane[row] : nullptr;
        Gap gap{0.0, (before != nullptr ? before : behind)->state.speed_mps, behind};
        double nearest_m = -std::numeric_limits<double>::infinity();
        double farthest_m = std::numeric_limits<double>::infinity();
        if (behind != nullptr) {
            const bool automated = behind->vehicle_class == traffic::VehicleClass::automated;
            nearest_m = behind->state.lane_position_m - vehicle.state.lane_position_m + own.length_m +
                        view.info_of(*behind).minimum_gap_m +
                        (automated ? headways.automated_s : headways.usual_s) * behind->state.speed_mps;
        }
        if (before != nullptr)
            farthest_m = before->state.lane_position_m - vehicle.state.lane_position_m -
                         view.info_of(*before).length_m - own.minimum_gap_m - headways.usual_s * gap.flow_mps;
        if (nearest_m > farthest_m) continue;
        gap.shift_m = std::clamp(0.0, nearest_m, farthest_m);
        if (!best || std::abs(gap.shift_m) < std::abs(best->shift_m)) best = gap;
    }
    return best;
}

}  // namespace clearway::policy::detail
