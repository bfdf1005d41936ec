#include "policy/pull_aside.hpp"

#include "policy/detail/view.hpp"

namespace clearway::policy {

void PullAside::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("pull_aside", context_.period, belief.time, leases, config_.lease_s,
                              detail::aside_priority);
    const std::vector<traffic::BelievedVehicle> emergencies = view.emergency_vehicles();
    memory_.keep_only(emergencies);
    const core::Metres horizon(config_.horizon_m);
    for (const traffic::BelievedVehicle& emergency : emergencies) {
        memory_.renew(
            view, emergency, [&](const auto& place) { return view.is_ahead(emergency, place, horizon); },
            write);
        const std::vector<detail::VehicleAhead> ahead = view.vehicles_ahead(emergency, horizon);
        if (ahead.empty()) continue;
        const Audience audience(belief, emergency.key, config_);
        const detail::LanePlan plan({view, emergency, ahead, audience}, config_, config_.horizon_m);
        const double slow_mps = config_.slow_share * view.allowed_speed(emergency).value;
        for (const detail::VehicleAhead& other : ahead) {
            const traffic::BelievedVehicle& vehicle = *other.vehicle;
            const auto column = plan.column_of(vehicle.state.lane);
            const bool in_the_way = column && column == plan.column_at(other.distance_m);
            if (!in_the_way || !audience.has(vehicle) || vehicle.state.speed_mps > slow_mps) continue;
            write.add(vehicle.key, traffic::PullAside{}, "in an emergency vehicle's way", emergency.key);
            memory_.note(emergency, vehicle);
        }
        detail::follow(plan, emergency, config_.change_ahead_s, write);
    }
}

}  // namespace clearway::policy
