#include "policy/pull_over.hpp"

#include <cmath>
#include <numbers>

#include "policy/detail/view.hpp"
#include "roads/shoulder.hpp"

namespace clearway::policy {
namespace {

/// Opposite headings differ by more than this, rad.
constexpr double opposite_rad = 2.6;

/// Whether a vehicle can stop on a shoulder where it is.
bool has_shoulder(const detail::View& view, const traffic::BelievedVehicle& vehicle) {
    const auto edge = view.edge_of(vehicle);
    return edge && roads::has_shoulder(view.network(), *edge);
}

/// Whether the two meet: opposite headings, the other one ahead within `reach_m`.
bool is_oncoming(const traffic::MotionState& own, const traffic::MotionState& other, double reach_m) {
    const double east_m = other.x_m - own.x_m;
    const double north_m = other.y_m - own.y_m;
    const double ahead_m = east_m * std::cos(own.heading_rad) + north_m * std::sin(own.heading_rad);
    const double turned_rad =
        std::abs(std::remainder(other.heading_rad - own.heading_rad, 2.0 * std::numbers::pi));
    return ahead_m > 0.0 && std::hypot(east_m, north_m) < reach_m && turned_rad > opposite_rad;
}

}  // namespace

void PullOver::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("pull_over", context_.period, belief.time, leases, config_.lease_s,
                              detail::aside_priority);
    const std::vector<traffic::BelievedVehicle> emergencies = view.emergency_vehicles();
    memory_.keep_only(emergencies);
    const core::Metres horizon(config_.horizon_m);
    for (const traffic::BelievedVehicle& emergency : emergencies) {
        const auto in_the_way = [&](const traffic::MotionState& place) {
            return view.is_ahead(emergency, place, horizon) ||
                   is_oncoming(emergency.state, place, config_.oncoming_m);
        };
        memory_.renew(view, emergency, in_the_way, write);
        const Audience audience(belief, emergency.key, config_);
        const double slow_mps = config_.slow_share * view.allowed_speed(emergency).value;
        bool has_stranger = false;
        for (const detail::VehicleAhead& other : view.vehicles_ahead(emergency, horizon)) {
            const traffic::BelievedVehicle& vehicle = *other.vehicle;
            if (!has_shoulder(view, vehicle) || vehicle.state.speed_mps > slow_mps) continue;
            has_stranger = has_stranger || !audience.has(vehicle);
            if (!audience.has(vehicle)) continue;
            write.add(vehicle.key, traffic::PullAside{}, "pulls over for an emergency vehicle",
                      emergency.key);
            memory_.note(emergency, vehicle);
        }
        if (!has_stranger) continue;
        for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
            if (!audience.has(vehicle) || !has_shoulder(view, vehicle) ||
                !is_oncoming(emergency.state, vehicle.state, config_.oncoming_m))
                continue;
            write.add(vehicle.key, traffic::PullAside{}, "keeps the oncoming lane free", emergency.key);
            memory_.note(emergency, vehicle);
        }
    }
}

}  // namespace clearway::policy
