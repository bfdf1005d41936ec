#pragma once

#include <memory>
#include <vector>

#include "policy/policy.hpp"

namespace clearway::policy {

/// The default combination: PreemptSignals, RecoverSignals and ClearLane. Their leases carry their own names.
class Corridor : public Policy {
  public:
    /// `settings` are the numbers of its three policies: `preempt_signals.lead_s`.
    explicit Corridor(const PolicyContext& context, const core::Settings& settings = {});

    std::string_view name() const override { return "corridor"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    std::vector<std::unique_ptr<Policy>> policies_;
};

}  // namespace clearway::policy
