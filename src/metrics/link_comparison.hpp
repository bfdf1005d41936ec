#pragma once

#include <cstdint>
#include <vector>

#include "metrics/run_metrics.hpp"
#include "metrics/true_links.hpp"
#include "traffic/belief.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics {

/// Matches a believed graph with the truth at the same time: which true vehicle each believed one is, and
/// which believed links are true. O(vehicles + links log degree). Keeps its buffers.
class BeliefMatch {
  public:
    void match(const truth::Snapshot& snapshot, const traffic::BelievedGraph& belief);

    /// By believed vehicle: its row of the snapshot; `core::no_row` when it is no longer on the road.
    const std::vector<core::VehicleIndex>& true_rows() const { return true_row_; }
    /// By row of the snapshot: the believed vehicle; `core::no_row` when the belief lacks it.
    const std::vector<core::VehicleIndex>& believed_rows() const { return believed_row_; }

    /// Calls `visit(left, right, is_true)` for every believed link, left < right by believed vehicle. A link
    /// with a vehicle that has left the road is false. `belief` and `truth` are of the moment matched last.
    template <class Visit>
    void for_each_link(const traffic::BelievedGraph& belief, const TrueLinks& truth,
                       const Visit& visit) const {
        for (core::VehicleIndex left = 0; left < belief.vehicles.size(); ++left) {
            for (const traffic::BelievedLink& link : belief.links_of(left)) {
                if (link.neighbour > left)
                    visit(left, link.neighbour, truth.linked(true_row_[left], true_row_[link.neighbour]));
            }
        }
    }

  private:
    std::vector<core::VehicleKey> believed_key_;
    std::vector<core::VehicleIndex> true_row_, believed_row_;
};

/// Counts believed links against true ones over the course of a run.
class LinkComparison {
  public:
    /// Adds the counts of one moment. An end is dark when the belief lacks it or holds a report older than
    /// `fresh_age_s`.
    void add(const truth::Snapshot& snapshot, const TrueLinks& truth, const traffic::BelievedGraph& belief,
             float fresh_age_s);

    LinkCounts all;
    LinkCounts dark;  ///< Links with at least one dark end.

  private:
    void find_dark(const traffic::BelievedGraph& belief, float fresh_age_s);

    BeliefMatch match_;
    std::vector<std::uint8_t> believed_is_dark_, row_is_dark_;
};

}  // namespace clearway::metrics
