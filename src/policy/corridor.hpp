#pragma once

#include <vector>

#include "policy/clear_lane.hpp"
#include "policy/give_way.hpp"
#include "policy/policy.hpp"
#include "policy/preempt_signals.hpp"
#include "policy/recover_signals.hpp"

namespace clearway::policy {

/// The default combination of PreemptSignals, RecoverSignals, ClearLane and GiveWay. Each lease carries the
/// name of the policy that issued it.
class Corridor : public Policy {
  public:
    /// `settings` are those of the four policies, such as `preempt_signals.lead_s`.
    explicit Corridor(const PolicyContext& context, const core::Settings& settings = {});

    std::string_view name() const override { return "corridor"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
    SignalMessages* messages() override { return preempt_signals_.messages(); }

  private:
    PreemptSignals preempt_signals_;
    RecoverSignals recover_signals_;
    ClearLane clear_lane_;
    GiveWay give_way_;
};

}  // namespace clearway::policy
