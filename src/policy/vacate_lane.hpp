#pragma once

#include "policy/configured_policy.hpp"
#include "policy/detail/cooperation.hpp"
#include "policy/detail/lane_plan.hpp"

namespace clearway::policy {

/// Settings of VacateLane.
struct VacateLaneConfig : detail::LanePlanConfig {
    double horizon_m = 300.0;
    /// The emergency vehicle begins a planned lane change this long before its place. Assumed: SUMO's
    /// vehicles change within 3 s.
    static constexpr double change_ahead_s = 4.0;
    /// Vehicles closer than this along the road cannot move into the same lane side by side. As clear_lane.
    static constexpr double side_room_m = 12.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = VacateLaneConfig;
        using core::Field;
        table(Field{"horizon_m", "m", &C::horizon_m, 10.0, 2000.0,
                    "The way is planned and vacated this far ahead",
                    "trials: 800 m costs others more than the emergency vehicle gains by it"},
              detail::lifetime_field<C>());
        detail::LanePlanConfig::fields(table);
    }
};

/// Plans the emergency vehicle's way through the lanes, around vehicles that make no room, and vacates it:
/// vehicles on the way change lanes, those beside it stay where they are, and the emergency vehicle follows
/// the plan.
class VacateLane : public ConfiguredPolicy<VacateLaneConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "vacate_lane"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
};

}  // namespace clearway::policy
