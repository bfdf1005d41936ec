#pragma once

#include <cstdint>
#include <vector>

#include "graph/proximity.hpp"
#include "metrics/run_metrics.hpp"
#include "traffic/belief.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// Compares believed links with true ones by vehicle key: O(vehicles + links log degree). Keeps its buffers.
class LinkComparison {
  public:
    /// Adds one moment to the counts. An end is dark when the belief lacks it or holds a report older than
    /// `fresh_age_s`; a believed vehicle that has left the road makes its links false.
    void add(const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
             const traffic::BelievedGraph& belief, float fresh_age_s);

    LinkCounts all;
    LinkCounts dark;  ///< Links with at least one dark end.

  private:
    void match(const truth::Snapshot& snapshot, const traffic::BelievedGraph& belief, float fresh_age_s);

    std::vector<std::uint32_t> row_of_believed_;
    std::vector<std::uint8_t> believed_is_dark_;
    std::vector<std::uint8_t> row_is_dark_;
};

}  // namespace clearway::metrics::detail
