#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "experiment/loop_config.hpp"
#include "loop/trials.hpp"
#include "policy/signal_messages.hpp"
#include "roads/network.hpp"

namespace clearway::loop {

/// Tries other times from which a signal could be held for an emergency vehicle, and never, in forked
/// children of the run, whose future is the true one: each signal once, when the vehicle comes near it. All
/// else in a child is as the condition has it. What the best of them would have saved is the regret of the
/// condition's own rule. The run itself does not notice, unless LoopConfig::best_hold_taken asks for the best
/// one.
class HoldTrials : public TriedAtSteps {
  public:
    /// Keeps a reference to the network. `equipped`: by signal, those that take part; empty: all. Children
    /// write into `folder`, which is removed.
    HoldTrials(const roads::Network& network, const experiment::LoopConfig& config,
               std::vector<bool> equipped, std::filesystem::path folder);

    void look(ClosedLoop& loop, core::Seconds horizon) override;
    /// Once the run is over: an emergency vehicle that did not arrive counts with `horizon`.
    metrics::TriedChoices result(core::Seconds horizon) const { return trials_.result(horizon); }

  private:
    /// A request that is due, of the vehicle in this row.
    std::optional<policy::RequestKey> due(const ClosedLoop& loop, std::uint32_t row);
    void try_holds(ClosedLoop& loop, policy::RequestKey request, core::Seconds horizon);

    const roads::Network& network_;
    experiment::LoopConfig config_;
    std::vector<bool> equipped_;
    std::filesystem::path folder_;
    std::set<policy::RequestKey> seen_;
    std::map<core::VehicleKey, double> next_s_;  ///< When holds for a vehicle are tried next.
    Trials trials_;
};

}  // namespace clearway::loop
