#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "metrics/road_layout.hpp"
#include "metrics/traffic_tables.hpp"
#include "traffic/lease.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::metrics::detail {

/// Counts the edges of ways that policies considered for emergency vehicles, and did not ask for.
class ConsideredWatch {
  public:
    /// The layout outlives the watch.
    explicit ConsideredWatch(const RoadLayout& layout) : layout_(layout) {}

    /// One step, with the leases that policies issued in it.
    void step(const traffic::Roster& roster, std::span<const traffic::Lease> leases);
    std::vector<ConsideredRow> rows() const;

  private:
    const RoadLayout& layout_;
    std::map<std::pair<std::string, core::EdgeIndex>, std::uint64_t> decisions_;  ///< By vehicle and edge.
};

}  // namespace clearway::metrics::detail
