#pragma once

#include <cstddef>

#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of Dissertation.
struct DissertationConfig {
    std::size_t min_edges = 1;  ///< As in Listing55.
    double slow_factor = 0.8;   ///< Of the emergency vehicle's speed, (0, 1]; the listing's factor.
    double slowest_mps =
        5.0;  ///< Nobody is slowed below; assumed: faster than a queue, slower than a street.
    double beside_behind_m =
        10.0;  ///< "Beside": front at most this far behind the emergency vehicle's; two car lengths.
    double beside_ahead_m = 10.0;  ///< The same ahead.
    double ahead_m = 50.0;         ///< Farthest to which a lane is cleared: the link radius.
};

/// The action policy that section 4.3 of the dissertation describes in words, made workable (*corrected*):
/// emergency vehicles drive at what they are allowed; an automated vehicle linked to one and ahead on its
/// lane changes lane; one beside it on a neighbouring lane slows to let it in. Every wish is a lease of 2 s
/// that ends by itself, and slowing has a floor, so nothing decays to a standstill.
class Dissertation : public Part {
  public:
    explicit Dissertation(const PartContext& context, DissertationConfig config = {});

    std::string_view name() const override { return "dissertation"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    PartContext context_;
    DissertationConfig config_;
};

}  // namespace clearway::policy
