#include "traffic/lease.hpp"

#include <array>

namespace clearway::traffic {

bool Stretch::has(VehicleClass vehicle_class, const MotionState& state) const {
    const bool is_meant = vehicle_class == VehicleClass::automated ||
                          (vehicle_class == VehicleClass::human && addressed == Addressed::drivers);
    return is_meant && state.lane == lane && state.lane_position_m > from_m &&
           state.lane_position_m <= to_m && state.speed_mps < below_mps;
}

std::string_view name(const Action& action) {
    static constexpr std::array<std::string_view, std::variant_size_v<Action>> names = {
        "drive_at",     "change_lane", "hold_lane",    "pull_aside",
        "stop_at_line", "hold_green",  "adjust_green", "pass_red"};
    return names[action.index()];
}

std::string_view counted_as(const Lease& lease) {
    const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target);
    const bool is_own = vehicle != nullptr && *vehicle == lease.beneficiary;
    return is_own && std::holds_alternative<ChangeLane>(lease.action) ? own_change_lane : name(lease.action);
}

}  // namespace clearway::traffic
