#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "policy/signal_messages.hpp"
#include "roads/network.hpp"
#include "traffic/request_counts.hpp"
#include "traffic/signal_status.hpp"
#include "traffic/vehicle.hpp"
#include "truth/snapshot.hpp"

namespace clearway::pipeline {

/// Counts greens that signals hold for emergency vehicles, whichever policy asked, and those in which the
/// vehicle did not pass the stop line: it had passed before, or came later. A green lasts from the step at
/// which all ways of the vehicle are green in a hold until they are not. A vehicle that leaves the network
/// counts as passed; a green that goes on at the end of the run is not judged.
class GreenWatch {
  public:
    /// The network outlives the watch.
    explicit GreenWatch(const roads::Network& network) : network_(network) {}

    /// At each step, after signals were told what to do.
    void step(std::span<const traffic::SignalStatus> signals, const truth::Snapshot& snapshot,
              const traffic::Roster& roster);
    const traffic::HeldGreenCounts& counts() const { return counts_; }

  private:
    struct Green {
        /// Place in the route of the edge that ends at the stop line; none if that is not ahead.
        std::optional<std::uint32_t> line;
        double began_s = 0.0;
        double seen_s = 0.0;  ///< The last step at which it was green.
        bool is_used = false;
    };

    std::optional<std::uint32_t> line_ahead(const policy::RequestKey& key, const truth::Snapshot& snapshot,
                                            const traffic::Roster& roster) const;
    bool has_passed(const policy::RequestKey& key, const Green& green, const truth::Snapshot& snapshot) const;

    const roads::Network& network_;
    std::map<policy::RequestKey, Green> greens_;
    traffic::HeldGreenCounts counts_;
};

}  // namespace clearway::pipeline
