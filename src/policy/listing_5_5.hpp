#pragma once

#include <map>

#include "core/fields.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/edge_rule.hpp"

namespace clearway::policy {

/// Settings of Listing55.
struct Listing55Config : detail::EdgeRule {
    /// A vehicle whose score is above this is told to drive faster. Listing 5.5; scores are -1, 0 and 1.
    static constexpr double raise_above = 0.5;
    /// A vehicle whose score is below this is told to drive slower. Listing 5.5; scores are -1, 0 and 1.
    static constexpr double lower_below = -0.5;
    /// Faster by this factor. Listing 5.5.
    static constexpr double raise_factor = 1.1;
    /// Slower by this factor. Listing 5.5.
    static constexpr double lower_factor = 0.8;
    /// Lifetime of a set speed, which every decision renews. Assumed: far longer than the time between two
    /// decisions, because setSpeed holds.
    static constexpr double set_speed_lease_s = 30.0;
    /// A lane is free when no linked vehicle on it is nearer than this along the road. Assumed: a car's
    /// length and two gaps.
    static constexpr double room_m = 10.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = Listing55Config;
        using core::Field;
        EdgeRule::fields(table);
        table(Field{"lease_s", "s", &C::lease_s, 0.1, 60.0,
                    "Lifetime of a lane change that is not renewed; at least two periods",
                    "assumed: four decisions at the usual period"});
    }
};

/// The dissertation's listing 5.5, *as published*, with the score of section 4.3 in our reading. A reference
/// that keeps the listing's defects, each noted in the source where it acts; docs/findings/policies.md says
/// what they cost.
class Listing55 : public ConfiguredPolicy<Listing55Config> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "listing_5_5"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    std::map<core::VehicleKey, double> set_speed_mps_;  ///< Never released: see `act`.
};

}  // namespace clearway::policy
