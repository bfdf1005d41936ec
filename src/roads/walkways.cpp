#include "roads/walkways.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include <fmt/format.h>

namespace clearway::roads {

Walkways::Walkways(const Network& network) : network_(network), parents_(network.lanes().size()) {
    std::iota(parents_.begin(), parents_.end(), 0U);
    const auto edge_of = [&](core::LaneIndex lane) -> const Edge& {
        return network_.edge(network_.lane(lane).edge);
    };
    for (std::uint32_t row = 0; row < network_.lanes().size(); ++row) {
        for (const Connection& way : network_.connections_from(core::LaneIndex{row})) {
            const Edge& from = edge_of(way.from);
            const Edge& to = edge_of(way.to);
            if ((from.walking_area || from.crossing) && (to.walking_area || to.crossing))
                unite(way.from, way.to);
            else if (to.walking_area)
                areas_[{way.from, LaneEnd::last}] = way.to;
            else if (from.walking_area)
                areas_[{way.to, LaneEnd::first}] = way.from;
        }
    }
}

bool Walkways::open(core::EdgeIndex edge) const {
    const Edge& row = network_.edge(edge);
    return std::ranges::any_of(network_.lanes().subspan(row.first_lane, row.lane_count),
                               &Lane::allows_pedestrians);
}

std::optional<std::string> Walkways::fault(std::span<const core::EdgeIndex> edges) const {
    const auto id = [&](std::size_t row) { return network_.edge(edges[row]).id; };
    for (std::size_t row = 0; row < edges.size(); ++row) {
        if (!open(edges[row])) return fmt::format("edge \"{}\" is closed to pedestrians", id(row));
        // A person who turns round like this can make SUMO fail an assertion.
        if ((row > 0 && edges[row] == edges[row - 1]) || (row > 1 && edges[row] == edges[row - 2]))
            return fmt::format("its walk comes back to edge \"{}\" at once", id(row));
    }
    const Course forward = course(edges, LaneEnd::last);
    const Course backward = course(edges, LaneEnd::first);
    const bool either_is_sound = forward.worst == Link::by_areas || backward.worst == Link::by_areas;
    const auto holds = [](const Course& course) { return course.worst >= Link::straight_over; };
    // Where both directions lead on, SUMO uses its router, which does not know ways straight over a junction.
    const bool both = forward.worst > Link::apart && backward.worst > Link::apart;
    if (either_is_sound || (both ? holds(forward) && holds(backward) : holds(forward) || holds(backward)))
        return std::nullopt;
    const std::size_t row = std::max(forward.first_gap, backward.first_gap);
    assert(row > 0);
    return fmt::format("its walk has a gap: nobody gets from edge \"{}\" to \"{}\" on foot", id(row - 1),
                       id(row));
}

/// The course of a walk whose first edge is left at `start`.
Walkways::Course Walkways::course(std::span<const core::EdgeIndex> edges, LaneEnd start) const {
    Course course;
    LaneEnd leaves = start;
    for (std::size_t row = 1; row < edges.size(); ++row) {
        const Link forward = link(edges[row - 1], leaves, edges[row], LaneEnd::first);
        const Link best =
            forward != Link::apart ? forward : link(edges[row - 1], leaves, edges[row], LaneEnd::last);
        leaves = forward != Link::apart ? LaneEnd::last : LaneEnd::first;
        if (best < Link::straight_over && course.first_gap == 0) course.first_gap = row;
        course.worst = std::min(course.worst, best);
        if (best == Link::apart) break;
    }
    return course;
}

std::uint32_t Walkways::area_group(core::LaneIndex lane) const {
    std::uint32_t row = lane.value;
    while (parents_[row] != row)
        row = parents_[row];
    return row;
}

void Walkways::unite(core::LaneIndex one, core::LaneIndex other) {
    parents_[area_group(one)] = area_group(other);
}

std::vector<std::uint32_t> Walkways::groups_at(core::EdgeIndex edge, LaneEnd end) const {
    std::vector<std::uint32_t> groups;
    for (std::uint32_t number = 0; number < network_.edge(edge).lane_count; ++number) {
        const core::LaneIndex lane = network_.lane_of(edge, number);
        const auto area = areas_.find({lane, end});
        if (network_.lane(lane).allows_pedestrians && area != areas_.end())
            groups.push_back(area_group(area->second));
    }
    return groups;
}

Walkways::Link Walkways::link(core::EdgeIndex from, LaneEnd from_end, core::EdgeIndex to,
                              LaneEnd to_end) const {
    const auto junction = [&](core::EdgeIndex edge, LaneEnd end) -> const std::string& {
        const Edge& row = network_.edge(edge);
        return end == LaneEnd::first ? row.from_junction : row.to_junction;
    };
    if (junction(from, from_end) != junction(to, to_end)) return Link::apart;
    const std::vector<std::uint32_t> left = groups_at(from, from_end);
    const std::vector<std::uint32_t> reached = groups_at(to, to_end);
    if (left.empty()) return Link::straight_over;
    const bool joined = std::ranges::any_of(
        left, [&](std::uint32_t group) { return std::ranges::count(reached, group) > 0; });
    return joined ? Link::by_areas : Link::barred;
}

}  // namespace clearway::roads
