#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "experiment/loop_config.hpp"
#include "loop/trials.hpp"
#include "metrics/tried_choices.hpp"
#include "roads/route_search.hpp"

namespace clearway::loop {

/// Drives other ways of emergency vehicles to their ends in forked children of the run, whose future is the
/// true one: the same vehicles, signals and drivers, and the condition's own policies for all but the choice
/// of the way. What the best of them would have saved is the regret of the way that was chosen. The run
/// itself does not notice, unless LoopConfig::best_way_taken asks for the best one.
class WayTrials : public TriedAtSteps {
  public:
    /// Keeps a reference to the network. Children write into `folder`, which is removed.
    WayTrials(const roads::Network& network, const experiment::LoopConfig& config,
              std::filesystem::path folder);

    void look(ClosedLoop& loop, core::Seconds horizon) override;
    /// Once the run is over: an emergency vehicle that did not arrive counts with `horizon`.
    metrics::TriedChoices result(core::Seconds horizon) const { return trials_.result(horizon); }

  private:
    void try_ways(ClosedLoop& loop, std::uint32_t row, core::Seconds horizon);
    /// In a copy of the run, after `change`.
    double arrival_s(ClosedLoop& loop, core::VehicleKey vehicle, core::Seconds horizon,
                     const std::function<bool()>& change);

    const roads::Network& network_;
    experiment::LoopConfig config_;
    std::filesystem::path folder_;
    roads::RouteSearch search_;
    std::map<core::VehicleKey, double> next_s_;  ///< When ways of a vehicle are tried next.
    Trials trials_;
};

}  // namespace clearway::loop
