#pragma once

#include <memory>
#include <vector>

#include "policy/part.hpp"

namespace clearway::policy {

/// The default combination: PreemptSignals, RecoverSignals and ClearLane. Their leases carry their own names.
class Corridor : public Part {
  public:
    explicit Corridor(const PartContext& context);

    std::string_view name() const override { return "corridor"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace clearway::policy
