#pragma once

#include "policy/configured_policy.hpp"
#include "policy/detail/cooperation.hpp"
#include "policy/detail/lane_plan.hpp"

namespace clearway::policy {

/// Settings of PullAside.
struct PullAsideConfig : detail::LanePlanConfig {
    double horizon_m = 120.0;
    double slow_share = 0.2;
    /// The emergency vehicle begins a planned lane change this long before its place. As vacate_lane.
    static constexpr double change_ahead_s = 4.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = PullAsideConfig;
        using core::Field;
        table(Field{"horizon_m", "m", &C::horizon_m, 10.0, 2000.0, "Vehicles this far ahead pull aside",
                    "assumed: the length of a queue"},
              Field{"slow_share", "1", &C::slow_share, 0.01, 2.0,
                    "Only those slower than this share of the emergency vehicle's allowed speed",
                    "trials on the arterial: better than 0.6 for the emergency vehicle and for others"},
              detail::lifetime_field<C>());
        detail::LanePlanConfig::fields(table);
    }
};

/// Queues make room: vehicles that stand or crawl on the emergency vehicle's way pull aside until it has
/// passed. The way leads around those that do not (detail::LanePlan). Without the sublane model the vehicles
/// stop beside the road, from whichever lane, which is more generous than a real queue; with it they keep to
/// the edge of their lane.
class PullAside : public ConfiguredPolicy<PullAsideConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "pull_aside"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    detail::AsideMemory memory_;
};

}  // namespace clearway::policy
