#pragma once

#include "policy/ask.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/cooperation.hpp"

namespace clearway::policy {

/// Settings of HoldCross.
struct HoldCrossConfig : AskSettings {
    double lead_s = 6.0;
    double horizon_m = 200.0;
    double near_m = 80.0;
    /// Arrival is estimated with at least this speed. Assumed: an emergency vehicle passes red with 20
    /// km/h.
    static constexpr double slowest_mps = 5.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = HoldCrossConfig;
        using core::Field;
        table(Field{"lead_s", "s", &C::lead_s, 0.0, 60.0,
                    "Cross traffic is held from this long before the emergency vehicle's arrival",
                    "assumed: a car crosses a junction in 3 s"},
              Field{"horizon_m", "m", &C::horizon_m, 1.0, 2000.0,
                    "Signals farther away than this are ignored", "assumed: 6 s at 120 km/h"},
              Field{"near_m", "m", &C::near_m, 1.0, 500.0,
                    "Vehicles closer than this to their stop line are asked",
                    "assumed: more than the usual braking distance in towns"},
              detail::lifetime_field<C>());
        AskSettings::fields(table);
    }
};

/// Cross traffic gives way: vehicles that have green and would cross the emergency vehicle's way stop at
/// their line until it has passed, and with them everybody behind them.
class HoldCross : public ConfiguredPolicy<HoldCrossConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "hold_cross"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
};

}  // namespace clearway::policy
