#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "metrics/road_layout.hpp"
#include "metrics/traffic_tables.hpp"
#include "traffic/lease.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// Counts how long signals are held: a policy asks for green on some links, and one of them is green.
class HoldWatch {
  public:
    /// The layout outlives the watch.
    explicit HoldWatch(const RoadLayout& layout);

    /// One step, with the leases that policies issued in it.
    void step(const truth::Snapshot& snapshot, std::span<const traffic::Lease> leases);
    std::vector<SignalHoldRow> rows() const;

  private:
    struct Hold {
        double until_s = -1.0;  ///< Expiry of the latest lease.
        std::vector<std::uint16_t> links;
        std::uint64_t count = 0;
        double held_s = 0.0;
    };

    const RoadLayout& layout_;
    std::vector<Hold> holds_;  ///< By signal.
    double last_s_ = -1.0;
};

}  // namespace clearway::metrics::detail
