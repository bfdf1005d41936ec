#pragma once

#include "policy/ask.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/cooperation.hpp"

namespace clearway::policy {

/// Settings of PullOver.
struct PullOverConfig : AskSettings {
    double horizon_m = 300.0;
    double slow_share = 0.95;
    double oncoming_m = 600.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = PullOverConfig;
        using core::Field;
        table(
            Field{"horizon_m", "m", &C::horizon_m, 10.0, 2000.0, "Vehicles this far ahead pull over",
                  "as vacate_lane; in trials on a rural road the gain grew with it up to 600 m"},
            Field{"slow_share", "1", &C::slow_share, 0.01, 2.0,
                  "Only those slower than this share of the emergency vehicle's allowed speed",
                  "assumed: others are not in its way"},
            Field{"oncoming_m", "m", &C::oncoming_m, 0.0, 2000.0,
                  "Oncoming vehicles this far ahead also pull over while a vehicle that is not asked has to "
                  "be overtaken; 0: never",
                  "assumed: overtaking at 100 km/h takes 10 s, and the oncoming vehicle comes as far"},
            detail::lifetime_field<C>());
        AskSettings::fields(table);
    }
};

/// On roads with a shoulder, slower vehicles ahead stop on it until the emergency vehicle has passed. One
/// that will not is overtaken on the lane of oncoming traffic, which oncoming vehicles leave free in the same
/// way.
class PullOver : public ConfiguredPolicy<PullOverConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "pull_over"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    detail::AsideMemory memory_;
};

}  // namespace clearway::policy
