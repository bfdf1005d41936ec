#pragma once

#include <cstddef>
#include <map>

#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of Listing55.
struct Listing55Config {
    std::size_t min_edges =
        1;  ///< Acts only on a graph with this many links; 4.3: "sufficient edges", no number given.
};

/// The dissertation's listing 5.5, *as published*, with the score of section 4.3 in our reading. It is an
/// opponent and keeps its defects, each named in the source where it acts; docs/policies.md says what they
/// cost.
class Listing55 : public Part {
  public:
    explicit Listing55(const PartContext& context, Listing55Config config = {});

    std::string_view name() const override { return "listing_5_5"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    PartContext context_;
    Listing55Config config_;
    std::map<core::VehicleKey, double> set_speed_mps_;  ///< Never released: see `act`.
};

}  // namespace clearway::policy
