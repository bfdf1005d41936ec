#pragma once

#include "core/fields.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/edge_rule.hpp"

namespace clearway::policy {

/// Settings of Dissertation.
struct DissertationConfig : detail::EdgeRule {
    /// A vehicle alongside slows down to this share of the emergency vehicle's speed. The listing's factor.
    static constexpr double slow_factor = 0.8;
    /// But no slower than this. Assumed: faster than a queue, slower than a street.
    static constexpr double slowest_mps = 5.0;
    double beside_behind_m = 10.0;
    double beside_ahead_m = 10.0;
    double ahead_m = 50.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = DissertationConfig;
        using core::Field;
        EdgeRule::fields(table);
        table(
            Field{"beside_behind_m", "m", &C::beside_behind_m, 0.0, 200.0,
                  "A vehicle is alongside when its front is at most this far behind the emergency vehicle's",
                  "assumed: two car lengths"},
            Field{"beside_ahead_m", "m", &C::beside_ahead_m, 0.0, 200.0, "Or at most this far ahead",
                  "assumed: two car lengths"},
            Field{"ahead_m", "m", &C::ahead_m, 1.0, 1000.0, "A lane is cleared this far ahead",
                  "the link radius"},
            detail::lifetime_field<C>());
    }
};

/// The action policy that section 4.3 of the dissertation describes in words, made workable (*corrected*):
/// emergency vehicles drive at their allowed speed; an automated vehicle linked to one and ahead on its lane
/// changes lane; one alongside on a neighbouring lane slows down to let it in. Every request is a lease that
/// expires unless renewed, and slowing has a lower bound, so no speed decays to a standstill.
class Dissertation : public ConfiguredPolicy<DissertationConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "dissertation"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
};

}  // namespace clearway::policy
