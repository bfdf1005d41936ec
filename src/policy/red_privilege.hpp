#pragma once

#include "core/fields.hpp"
#include "policy/configured_policy.hpp"

namespace clearway::policy {

/// Settings of RedPrivilege.
struct RedPrivilegeConfig {
    double near_m = 200.0;
    /// Highest speed at a stop line that shows red. 20 km/h, assumed: slow enough to stop for traffic that
    /// has green.
    static constexpr double passing_mps = 5.56;
    /// The emergency vehicle slows down to that speed with this deceleration. Comfortable.
    static constexpr double braking_mps2 = 2.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = RedPrivilegeConfig;
        using core::Field;
        table(Field{"near_m", "m", &C::near_m, 1.0, 1000.0,
                    "The privilege begins at this distance from a signal that is not green",
                    "assumed: before the vehicle would brake"},
              detail::lifetime_field<C>());
    }
};

/// Emergency vehicles pass red signals, slowly and yielding, as the law of many countries allows. The
/// privilege ends with the red signal.
class RedPrivilege : public ConfiguredPolicy<RedPrivilegeConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "red_privilege"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
};

}  // namespace clearway::policy
