#include "scenario/detail/reachable_ends.hpp"

#include <utility>

namespace clearway::scenario::detail {

namespace {

using Edges = std::vector<core::EdgeIndex>;

/// Weight of each edge: its share of the total length, plus, at an end of the network, its share of the lanes
/// there.
std::vector<double> weights(const roads::Network& network, const roads::Reach& reach, const Edges& edges,
                            roads::Way way) {
    double length_m = 0.0;
    double lanes = 0.0;
    for (const core::EdgeIndex edge : edges) {
        length_m += network.edge(edge).length_m;
        if (reach.is_end(edge, way)) lanes += network.edge(edge).lane_count;
    }
    std::vector<double> result;
    result.reserve(edges.size());
    for (const core::EdgeIndex edge : edges)
        result.push_back(network.edge(edge).length_m / length_m +
                         (reach.is_end(edge, way) ? network.edge(edge).lane_count / lanes : 0.0));
    return result;
}

/// Draws an edge by weight among those for which `may_be_drawn` holds; `none` if there is none.
template <class MayBeDrawn>
core::EdgeIndex pick(const Edges& edges, const std::vector<double>& weight, double uniform,
                     const MayBeDrawn& may_be_drawn) {
    double sum = 0.0;
    for (std::size_t row = 0; row < edges.size(); ++row)
        if (may_be_drawn(edges[row])) sum += weight[row];
    double left = uniform * sum;
    core::EdgeIndex drawn;
    for (std::size_t row = 0; row < edges.size(); ++row) {
        if (!may_be_drawn(edges[row])) continue;
        drawn = edges[row];
        if (left < weight[row]) break;
        left -= weight[row];
    }
    return drawn;
}

}  // namespace

ReachableEnds::ReachableEnds(const roads::Network& network, Edges edges)
    : reach_(network),
      edges_(std::move(edges)),
      from_weight_(weights(network, reach_, edges_, roads::Way::back)),
      to_weight_(weights(network, reach_, edges_, roads::Way::onward)) {}

core::EdgeIndex ReachableEnds::origin(double uniform) const {
    return pick(edges_, from_weight_, uniform, [](core::EdgeIndex) { return true; });
}

core::EdgeIndex ReachableEnds::other_end(core::EdgeIndex end, roads::Way way, double uniform) const {
    const std::vector<bool> reached = reach_.from(end, way);
    return pick(edges_, way == roads::Way::onward ? to_weight_ : from_weight_, uniform,
                [&](core::EdgeIndex edge) { return reached[edge.value] && edge != end; });
}

}  // namespace clearway::scenario::detail
