#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "roads/crossings.hpp"
#include "roads/network.hpp"

namespace clearway::roads {

/// Where SUMO 1.15 lets people walk. They use an edge in either direction, and get from one to the next where
/// both meet: over the walking areas and crossings there, or, from a lane that ends at none, straight over
/// the junction. A walk that breaks these rules can crash SUMO when a person gets to the place, not when it
/// is loaded.
class Walkways {
  public:
    /// Keeps a reference to `network`.
    explicit Walkways(const Network& network);

    /// Whether pedestrians may use a lane of the edge.
    bool open(core::EdgeIndex edge) const;

    /// Why nobody can walk over `edges`, which lie outside junctions, in words: an edge is closed, two edges
    /// do not meet, or an edge is repeated at once. Nothing when the whole can be walked.
    std::optional<std::string> fault(std::span<const core::EdgeIndex> edges) const;

  private:
    /// How people get from the end of one edge to the end of another, worst first.
    enum class Link : std::uint8_t { apart, barred, straight_over, by_areas };
    /// The worst link of a walk, and the first edge that cannot be reached, if any.
    struct Course {
        Link worst = Link::by_areas;
        std::size_t first_gap = 0;
    };
    Course course(std::span<const core::EdgeIndex> edges, LaneEnd start) const;
    Link link(core::EdgeIndex from, LaneEnd from_end, core::EdgeIndex to, LaneEnd to_end) const;
    std::vector<std::uint32_t> groups_at(core::EdgeIndex edge, LaneEnd end) const;
    std::uint32_t area_group(core::LaneIndex lane) const;
    void unite(core::LaneIndex one, core::LaneIndex other);

    const Network& network_;
    /// Union-find by lane: its parent in its group of walking areas and crossings, or the lane itself if it
    /// represents the group.
    std::vector<std::uint32_t> parents_;
    std::map<std::pair<core::LaneIndex, LaneEnd>, core::LaneIndex> areas_;  ///< At the ends of lanes.
};

}  // namespace clearway::roads
