#pragma once

// A policy of your own: automated vehicles close behind an emergency vehicle drop back. See README.md.

#include <algorithm>

#include "policy/ask.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/cooperation.hpp"
#include "policy/detail/view.hpp"

namespace clearway::policy {

/// Settings of KeepDistance.
struct KeepDistanceConfig : AskSettings {
    double reach_m = 20.0;
    double speed_share = 0.8;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = KeepDistanceConfig;
        using core::Field;
        table(
            Field{"reach_m", "m", &C::reach_m, 1.0, 200.0, "Followers within this distance drop back",
                  "assumed: two seconds at 10 m/s"},
            Field{"speed_share", "1", &C::speed_share, 0.1, 1.0,
                  "They drive at this share of the emergency vehicle's speed", "as gap_factor of clear_lane"},
            detail::lifetime_field<C>());
        AskSettings::fields(table);
    }
};

/// Vehicles that follow an emergency vehicle closely on its lane drop back.
class KeepDistance : public ConfiguredPolicy<KeepDistanceConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "keep_distance"; }

    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override {
        const detail::View view(context_.network, belief);
        detail::LeaseWriter write("keep_distance", context_.period, belief.time, leases, config_.lease_s);
        for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
            const Audience audience(belief, emergency.key, config_);
            const core::Metres reach(config_.reach_m);
            for (const detail::VehicleAhead& behind : view.vehicles_behind(emergency, reach)) {
                const traffic::BelievedVehicle& follower = *behind.vehicle;
                if (follower.state.lane != emergency.state.lane || !audience.has(follower)) continue;
                // An emergency vehicle may drive faster than its followers are allowed to.
                const double speed_mps = std::min(config_.speed_share * emergency.state.speed_mps,
                                                  view.allowed_speed(follower).value);
                write.add(follower.key, traffic::DriveAt{core::MetresPerSecond(speed_mps)},
                          "close behind an emergency vehicle", emergency.key);
            }
        }
    }
};

}  // namespace clearway::policy
