#include "roads/fastest_routes.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "roads/detail/walk.hpp"

namespace clearway::roads {
namespace {

Point end_of(const Network& network, core::EdgeIndex edge) {
    return network.lane(core::LaneIndex{network.edge(edge).first_lane}).shape.back();
}

}  // namespace

FastestRoutes::FastestRoutes(const Network& network)
    : network_(network), edge_s_(network.edges().size(), unreachable_s), labels_(network.edges().size()) {
    first_way_.reserve(network.edges().size() + 1);
    for (std::uint32_t row = 0; row < network.edges().size(); ++row) {
        first_way_.push_back(static_cast<std::uint32_t>(ways_.size()));
        add_ways_from(core::EdgeIndex{row});
    }
    first_way_.push_back(static_cast<std::uint32_t>(ways_.size()));
    pace_s_per_m_ = least_pace();
}

void FastestRoutes::add_ways_from(core::EdgeIndex index) {
    const Edge& edge = network_.edge(index);
    for (std::uint32_t row = edge.first_lane; row < edge.first_lane + edge.lane_count; ++row) {
        const Lane& lane = network_.lane(core::LaneIndex{row});
        if (lane.allows_cars)
            edge_s_[index.value] = std::min(edge_s_[index.value], detail::free_flow_s(lane));
        if (edge.internal) continue;
        for (const Connection& connection : network_.connections_from(core::LaneIndex{row}))
            if (connection.allows_cars) add_way(connection);
    }
}

void FastestRoutes::add_way(const Connection& connection) {
    const core::EdgeIndex to = network_.lane(connection.to).edge;
    if (network_.edge(to).internal) return;
    Way way{to, static_cast<std::uint32_t>(inner_s_.size())};
    detail::for_each_inner_lane(network_, connection, [&](core::LaneIndex inner) {
        inner_s_.push_back(detail::free_flow_s(network_.lane(inner)));
        ++way.inner_count;
    });
    ways_.push_back(way);
}

std::span<const FastestRoutes::Way> FastestRoutes::ways_from(core::EdgeIndex edge) const {
    return std::span(ways_).subspan(first_way_[edge.value],
                                    first_way_[edge.value + 1] - first_way_[edge.value]);
}

std::span<const double> FastestRoutes::inner_s(const Way& way) const {
    return std::span(inner_s_).subspan(way.first_inner, way.inner_count);
}

double FastestRoutes::distance_m(core::EdgeIndex from, core::EdgeIndex to) const {
    const Point one = end_of(network_, from);
    const Point other = end_of(network_, to);
    return std::hypot(static_cast<double>(one.x_m) - other.x_m, static_cast<double>(one.y_m) - other.y_m);
}

/// Lengths of a file may be shorter than its shapes: what a way really brings nearer decides.
double FastestRoutes::least_pace() const {
    double least = unreachable_s;
    for (std::uint32_t row = 0; row < edge_s_.size(); ++row) {
        for (const Way& way : ways_from(core::EdgeIndex{row})) {
            double time_s = edge_s_[way.to.value];
            for (const double across_s : inner_s(way))
                time_s += across_s;
            const double nearer_m = distance_m(core::EdgeIndex{row}, way.to);
            if (nearer_m > 0.0) least = std::min(least, time_s / nearer_m);
        }
    }
    // A little less, so that rounding never puts an edge of a fastest way behind the destination.
    constexpr double rounding = 1e-6;
    return std::isfinite(least) ? least * (1.0 - rounding) : 0.0;
}

std::optional<std::vector<core::EdgeIndex>> FastestRoutes::between(core::EdgeIndex from, core::EdgeIndex to) {
    assert(from.exists() && to.exists());
    if (edge_s_[from.value] == unreachable_s || edge_s_[to.value] == unreachable_s) return std::nullopt;
    ++searches_;
    queue_.clear();
    Label& start = label(from, to);
    start.arrival_s = 0.0;
    queue_.push(start.rest_s, from);
    while (!queue_.empty()) {
        const auto [at_least_s, row] = queue_.pop();
        const Label& reached = labels_[row];
        if (at_least_s > reached.arrival_s + reached.rest_s) continue;  // a faster way was there before
        const core::EdgeIndex edge{row};
        if (edge == to) return path_to(to);
        for (const Way& way : ways_from(edge))
            relax(edge, way, to);
    }
    return std::nullopt;
}

void FastestRoutes::relax(core::EdgeIndex from, const Way& way, core::EdgeIndex destination) {
    const double left_s = labels_[from.value].arrival_s;
    double arrival_s = left_s + edge_s_[way.to.value];
    for (const double across_s : inner_s(way))
        arrival_s += across_s;
    // Final times stay final: no way may shorten them.
    assert(arrival_s >= left_s);
    Label& known = label(way.to, destination);
    if (arrival_s < known.arrival_s) {
        known.arrival_s = arrival_s;
        known.before = from;
        queue_.push(arrival_s + known.rest_s, way.to);
    } else if (arrival_s == known.arrival_s && left_s < arrival_s && known.before.exists() &&
               from < known.before) {
        known.before = from;
    }
}

FastestRoutes::Label& FastestRoutes::label(core::EdgeIndex edge, core::EdgeIndex destination) {
    Label& label = labels_[edge.value];
    if (label.search != searches_)
        label = {unreachable_s, pace_s_per_m_ * distance_m(edge, destination), core::EdgeIndex::none(),
                 searches_};
    return label;
}

std::vector<core::EdgeIndex> FastestRoutes::path_to(core::EdgeIndex to) const {
    std::vector<core::EdgeIndex> path;
    for (core::EdgeIndex edge = to; edge.exists(); edge = labels_[edge.value].before) {
        path.push_back(edge);
        assert(path.size() <= labels_.size());
    }
    std::ranges::reverse(path);
    return path;
}

}  // namespace clearway::roads
