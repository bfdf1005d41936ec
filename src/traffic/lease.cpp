#include "traffic/lease.hpp"

#include <array>

namespace clearway::traffic {
namespace {

/// In the order of Action.
constexpr std::array<LeaseKind, std::variant_size_v<Action>> kinds = {
    LeaseKind::drive_at,     LeaseKind::change_lane, LeaseKind::hold_lane,    LeaseKind::pull_aside,
    LeaseKind::stop_at_line, LeaseKind::hold_green,  LeaseKind::adjust_green, LeaseKind::pass_red,
    LeaseKind::stand_back,   LeaseKind::take_route};

}  // namespace

bool Stretch::has(VehicleClass vehicle_class, const MotionState& state) const {
    const bool is_meant = vehicle_class == VehicleClass::automated ||
                          (vehicle_class == VehicleClass::human && addressed == Addressed::drivers);
    return is_meant && state.lane == lane && state.lane_position_m > from_m &&
           state.lane_position_m <= to_m && state.speed_mps < below_mps;
}

std::string_view name(const Action& action) {
    return name(kinds[action.index()]);
}

LeaseKind kind_of(const Lease& lease) {
    const auto* const back = std::get_if<StandBack>(&lease.action);
    if (back != nullptr && !back->way.empty()) return LeaseKind::consider_way;
    const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target);
    const bool is_own = vehicle != nullptr && *vehicle == lease.beneficiary;
    return is_own && std::holds_alternative<ChangeLane>(lease.action) ? LeaseKind::own_change_lane
                                                                      : kinds[lease.action.index()];
}

}  // namespace clearway::traffic
