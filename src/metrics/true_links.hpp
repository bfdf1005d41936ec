#pragma once

#include <cstdint>

#include "core/match_rows.hpp"
#include "graph/proximity.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics {

/// Decides which vehicles are truly linked at a moment. The only source of that truth: for the labels of
/// samples, the evaluation of predictors, and the metrics of a run and of a replay. Keeps its buffers; one
/// thread.
class TrueLinks {
  public:
    explicit TrueLinks(const graph::LinkRules& rules) : rules_(rules) {}

    const graph::LinkRules& rules() const { return rules_; }

    /// Finds the true links of this moment with graph::ProximityBuilder. O(vehicles + links).
    void look(const truth::Snapshot& snapshot);

    /// The links of the last `look`; rows are those of its snapshot.
    const graph::ProximityGraph& graph() const { return graph_; }
    std::uint64_t link_count() const { return graph_.link_count(); }
    /// Whether two rows of the snapshot are linked. `core::no_row` stands for a vehicle that is not on the
    /// road (core::match_rows), which has no links. O(log degree).
    bool linked(core::VehicleIndex left, core::VehicleIndex right) const;

  private:
    graph::LinkRules rules_;
    graph::ProximityBuilder builder_;
    graph::ProximityGraph graph_;
};

}  // namespace clearway::metrics
