#include "roads/reach.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::roads {

std::vector<core::EdgeIndex> car_edges(const Network& network) {
    std::vector<core::EdgeIndex> edges;
    for (std::uint32_t row = 0; row < network.edges().size(); ++row) {
        const Edge& edge = network.edges()[row];
        const auto lanes = network.lanes().subspan(edge.first_lane, edge.lane_count);
        if (!edge.internal && std::ranges::any_of(lanes, &Lane::allows_cars))
            edges.push_back(core::EdgeIndex{row});
    }
    return edges;
}

Reach::Reach(const Network& network) : network_(network), predecessors_(network.edges().size()) {
    for (std::uint32_t row = 0; row < network.edges().size(); ++row)
        for (const core::EdgeIndex next : network.successors(core::EdgeIndex{row}))
            predecessors_[next.value].push_back(core::EdgeIndex{row});
}

bool Reach::is_end(core::EdgeIndex edge, Way way) const {
    return way == Way::onward ? network_.successors(edge).empty() : predecessors_[edge.value].empty();
}

std::vector<bool> Reach::from(core::EdgeIndex start, Way way) const {
    assert(start.exists());
    std::vector<bool> reached(network_.edges().size(), false);
    std::vector<core::EdgeIndex> open = {start};
    reached[start.value] = true;
    const auto visit = [&](core::EdgeIndex next) {
        if (reached[next.value]) return;
        reached[next.value] = true;
        open.push_back(next);
    };
    while (!open.empty()) {
        const core::EdgeIndex edge = open.back();
        open.pop_back();
        if (way == Way::onward)
            std::ranges::for_each(network_.successors(edge), visit);
        else
            std::ranges::for_each(predecessors_[edge.value], visit);
    }
    return reached;
}

}  // namespace clearway::roads
