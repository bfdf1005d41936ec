#pragma once

#include <memory>
#include <vector>

#include "policy/policy.hpp"

namespace clearway::policy {

/// The default combination of PreemptSignals, RecoverSignals, ClearLane and GiveWay. Each lease carries the
/// name of the policy that issued it.
class Corridor : public Policy {
  public:
    /// `settings` are those of the four policies, such as `preempt_signals.lead_s`.
    explicit Corridor(const PolicyContext& context, const core::Settings& settings = {});

    std::string_view name() const override { return "corridor"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
    SignalMessages* messages() override { return policies_.front()->messages(); }

  private:
    std::vector<std::unique_ptr<Policy>> policies_;  ///< PreemptSignals first.
};

}  // namespace clearway::policy
