#pragma once

#include <map>
#include <vector>

#include "core/fields.hpp"
#include "policy/configured_policy.hpp"

namespace clearway::policy {

/// Settings of GreenWave.
struct GreenWaveConfig {
    double before_s = 8.0;
    double after_s = 15.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = GreenWaveConfig;
        using core::Field;
        table(Field{"before_s", "s", &C::before_s, 0.0, 120.0,
                    "Green is asked for this long before the planned arrival", "as preempt_signals"},
              Field{"after_s", "s", &C::after_s, 0.0, 300.0, "And for this long after it",
                    "assumed: two stops of a vehicle behind plan"},
              detail::lifetime_field<C>());
    }
};

/// A reference: every signal on an emergency vehicle's route turns green around the time at which the vehicle
/// would get there at its allowed speed. The plan is made once, when the vehicle appears, and never
/// corrected.
class GreenWave : public ConfiguredPolicy<GreenWaveConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "green_wave"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    struct Window {
        core::SignalIndex signal;
        std::vector<std::uint16_t> links;
        double from_s;
        double until_s;
    };

    std::map<core::VehicleKey, std::vector<Window>> plans_;
};

}  // namespace clearway::policy
