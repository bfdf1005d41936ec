#include "roads/route_search.hpp"

#include <cassert>

#include "roads/detail/walk.hpp"

namespace clearway::roads {
namespace {

bool is_open(const Lane& lane, Driver driver) {
    return driver == Driver::car ? lane.allows_cars : lane.allows_emergency;
}
bool is_open(const Connection& way, Driver driver) {
    return driver == Driver::car ? way.allows_cars : way.allows_emergency;
}

}  // namespace

RouteSearch::RouteSearch(const Network& network, Driver driver)
    : free_s_(network.edges().size(), no_way_s), labels_(network.edges().size()) {
    first_arc_.reserve(network.edges().size() + 1);
    for (std::uint32_t row = 0; row < network.edges().size(); ++row) {
        const auto start = static_cast<std::ptrdiff_t>(arcs_.size());
        first_arc_.push_back(static_cast<std::uint32_t>(start));
        const Edge& edge = network.edge(core::EdgeIndex{row});
        if (edge.internal) continue;
        for (std::uint32_t lane = edge.first_lane; lane < edge.first_lane + edge.lane_count; ++lane) {
            const Lane& own = network.lane(core::LaneIndex{lane});
            if (!is_open(own, driver)) continue;
            free_s_[row] = std::min(free_s_[row], detail::free_flow_s(own));
            for (const Connection& way : network.connections_from(core::LaneIndex{lane})) {
                const core::EdgeIndex to = network.lane(way.to).edge;
                if (!is_open(way, driver) || network.edge(to).internal) continue;
                double inner_s = 0.0;
                detail::for_each_inner_lane(network, way, [&](core::LaneIndex inner) {
                    inner_s += detail::free_flow_s(network.lane(inner));
                });
                const auto known = std::find_if(arcs_.begin() + start, arcs_.end(),
                                                [&](const Arc& arc) { return arc.to == to; });
                if (known == arcs_.end())
                    arcs_.push_back({to, inner_s});
                else
                    known->inner_s = std::min(known->inner_s, inner_s);
            }
        }
    }
    first_arc_.push_back(static_cast<std::uint32_t>(arcs_.size()));
}

const RouteSearch::Arc* RouteSearch::arc(core::EdgeIndex from, core::EdgeIndex to) const {
    const std::span<const Arc> arcs = arcs_from(from);
    const auto found = std::ranges::find(arcs, to, &Arc::to);
    return found == arcs.end() ? nullptr : &*found;
}

const std::vector<double>& RouteSearch::bounds_to(core::EdgeIndex destination) {
    const auto [entry, is_new] = bounds_.try_emplace(destination);
    std::vector<double>& bounds = entry->second;
    if (!is_new) return bounds;
    struct Back {
        std::uint32_t from, to;
        double inner_s;
    };
    std::vector<Back> backward;
    backward.reserve(arcs_.size());
    for (std::uint32_t from = 0; from + 1 < first_arc_.size(); ++from)
        for (const Arc& arc : arcs_from(core::EdgeIndex{from}))
            backward.push_back({from, arc.to.value, arc.inner_s});
    std::ranges::sort(backward, {}, &Back::to);

    bounds.assign(free_s_.size(), no_way_s);
    if (free_s_[destination.value] == no_way_s) return bounds;
    bounds[destination.value] = 0.0;
    detail::LeastFirst queue;
    queue.push(0.0, destination);
    while (!queue.empty()) {
        const auto [rest_s, row] = queue.pop();
        if (rest_s > bounds[row]) continue;
        for (auto arc = std::ranges::lower_bound(backward, row, {}, &Back::to);
             arc != backward.end() && arc->to == row; ++arc) {
            const double whole_s = rest_s + free_s_[row] + arc->inner_s;
            if (whole_s >= bounds[arc->from]) continue;
            bounds[arc->from] = whole_s;
            queue.push(whole_s, core::EdgeIndex{arc->from});
        }
    }
    return bounds;
}

void RouteSearch::begin() {
    ++searches_;
    queue_.clear();
}

RouteSearch::Label& RouteSearch::label(core::EdgeIndex edge) {
    Label& label = labels_[edge.value];
    if (label.search != searches_) label = {no_way_s, core::EdgeIndex::none(), searches_};
    return label;
}

double RouteSearch::finish(core::EdgeIndex to, std::vector<core::EdgeIndex>& way) const {
    for (core::EdgeIndex edge = to; edge.exists(); edge = labels_[edge.value].before) {
        way.push_back(edge);
        assert(way.size() <= labels_.size());
    }
    std::ranges::reverse(way);
    return labels_[to.value].leaves_s;
}

}  // namespace clearway::roads
