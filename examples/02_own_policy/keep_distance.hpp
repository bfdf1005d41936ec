#pragma once

// A policy of your own: automated vehicles close behind an emergency vehicle drop back. See README.md.

#include <tuple>

#include "core/fields.hpp"
#include "policy/policy.hpp"

namespace clearway::policy {

/// Settings of KeepDistance.
struct KeepDistanceConfig {
    double reach_m = 20.0;

    static constexpr auto fields() {
        using C = KeepDistanceConfig;
        return std::make_tuple(core::Field{"reach_m", "m", &C::reach_m, 1.0, 200.0,
                                           "Followers within this distance drop back",
                                           "assumed: two seconds at 10 m/s"});
    }
};

class KeepDistance : public Policy {
  public:
    explicit KeepDistance(const PolicyContext&, const KeepDistanceConfig& config = {}) : config_(config) {}

    std::string_view name() const override { return "keep_distance"; }

    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override {
        for (core::VehicleIndex row = 0; row < belief.vehicles.size(); ++row) {
            const traffic::BelievedVehicle& emergency = belief.vehicles[row];
            if (emergency.vehicle_class != traffic::VehicleClass::emergency) continue;
            for (const traffic::BelievedLink& link : belief.links_of(row)) {
                ask(emergency, belief.vehicles[link.neighbour], belief.time, leases);
            }
        }
    }

  private:
    void ask(const traffic::BelievedVehicle& emergency, const traffic::BelievedVehicle& follower,
             core::Seconds now, std::vector<traffic::Lease>& leases) const {
        const float behind_m = emergency.state.lane_position_m - follower.state.lane_position_m;
        if (follower.vehicle_class != traffic::VehicleClass::automated) return;
        if (follower.state.lane != emergency.state.lane || behind_m <= 0.0F || behind_m > config_.reach_m) return;
        traffic::Lease lease;
        lease.target = follower.key;
        lease.action = traffic::DriveAt{core::MetresPerSecond(0.8 * emergency.state.speed_mps)};
        lease.expiry = now + core::Seconds(2.0);  // It ends by itself: nothing to release.
        lease.policy = "keep_distance";
        lease.reason = "close behind an emergency vehicle";
        lease.beneficiary = emergency.key;
        leases.push_back(lease);
    }

    KeepDistanceConfig config_;
};

}  // namespace clearway::policy
