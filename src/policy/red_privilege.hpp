#pragma once

#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of RedPrivilege.
struct RedPrivilegeConfig {
    double near_m = 200.0;  ///< Granted from this distance to a signal that is not green, (0, 1000]: before
                            ///< it would brake.
    double passing_mps = 5.56;  ///< Highest speed at a stop line that shows red, (0, 50]. 20 km/h: assumed,
                                ///< so slow that it can stop for those who have green.
    double braking_mps2 = 2.0;  ///< It slows down for that with this deceleration, (0, 9]; comfortable.
};

/// Emergency vehicles pass red signals, slowly and yielding, as the law of many countries allows. The
/// privilege ends with the red signal.
class RedPrivilege : public Part {
  public:
    explicit RedPrivilege(const PartContext& context, RedPrivilegeConfig config = {});

    std::string_view name() const override { return "red_privilege"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    PartContext context_;
    RedPrivilegeConfig config_;
};

}  // namespace clearway::policy
