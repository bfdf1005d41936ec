#include "policy/dissertation.hpp"

#include <algorithm>

#include "policy/detail/view.hpp"

namespace clearway::policy {
namespace {

using detail::LeaseWriter;
using detail::View;

/// Moves the automated vehicles linked to one emergency vehicle out of its lane.
class OneEmergency {
  public:
    OneEmergency(const View& view, const DissertationConfig& config,
                 const traffic::BelievedVehicle& emergency, LeaseWriter& write)
        : view_(view), config_(config), emergency_(emergency), write_(write) {}

    void ask(const traffic::BelievedVehicle& neighbour) {
        if (!view_.is_on_route(neighbour) || !view_.is_on_route(emergency_)) return;
        if (view_.network().edge(*view_.edge_of(neighbour)).internal) return;
        const auto distance =
            roads::distance_ahead(view_.network(), view_.route_of(emergency_.key), emergency_.state,
                                  neighbour.state, core::Metres(config_.ahead_m));
        if (distance && lane_at(*distance) == neighbour.state.lane)
            leave_lane(neighbour);
        else if (is_beside(neighbour))
            slow_down(neighbour);
    }

  private:
    /// The lane on which the emergency vehicle will be after `distance`.
    core::LaneIndex lane_at(core::Metres distance) const {
        return roads::advance(view_.network(), view_.route_of(emergency_.key), emergency_.state, distance)
            .state.lane;
    }

    bool is_beside(const traffic::BelievedVehicle& neighbour) const {
        if (view_.edge_of(neighbour) != view_.edge_of(emergency_)) return false;
        const std::uint32_t left = view_.lane_number(neighbour);
        const std::uint32_t right = view_.lane_number(emergency_);
        if (left + 1 != right && right + 1 != left) return false;
        const double ahead_m = neighbour.state.lane_position_m - emergency_.state.lane_position_m;
        return ahead_m >= -config_.beside_behind_m && ahead_m <= config_.beside_ahead_m;
    }

    void leave_lane(const traffic::BelievedVehicle& neighbour) {
        const std::vector<std::uint32_t> lanes = view_.usable_neighbours(neighbour);
        if (lanes.empty()) return;
        write_.add(neighbour.key, traffic::ChangeLane{lanes.front()}, "ahead of an emergency vehicle",
                   emergency_.key);
    }

    void slow_down(const traffic::BelievedVehicle& neighbour) {
        const double wished = std::max(config_.slow_factor * emergency_.state.speed_mps, config_.slowest_mps);
        const core::MetresPerSecond speed(std::min(wished, view_.allowed_speed(neighbour).value));
        write_.add(neighbour.key, traffic::DriveAt{speed}, "beside an emergency vehicle", emergency_.key);
    }

    const View& view_;
    const DissertationConfig& config_;
    const traffic::BelievedVehicle& emergency_;
    LeaseWriter& write_;
};

}  // namespace

void Dissertation::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    if (!config_.has_sufficient_edges(belief)) return;
    const View view(context_.network, belief);
    LeaseWriter write("dissertation", context_.period, belief.time, leases, config_.lease_s);
    for (core::VehicleIndex row = 0; row < belief.vehicles.size(); ++row) {
        const traffic::BelievedVehicle& emergency = belief.vehicles[row];
        if (emergency.vehicle_class != traffic::VehicleClass::emergency) continue;
        const core::MetresPerSecond allowed = view.allowed_speed(emergency);
        if (allowed.value > 0.0)
            write.add(emergency.key, traffic::DriveAt{allowed}, "towards its limit", emergency.key);
        OneEmergency one(view, config_, emergency, write);
        for (const traffic::BelievedLink& link : belief.links_of(row)) {
            const traffic::BelievedVehicle& neighbour = belief.vehicles[link.neighbour];
            if (config_.counts(link) && neighbour.vehicle_class == traffic::VehicleClass::automated)
                one.ask(neighbour);
        }
    }
}

}  // namespace clearway::policy
