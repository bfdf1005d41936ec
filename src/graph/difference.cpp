#include "graph/difference.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace clearway::graph {
namespace {

std::vector<LinkKeys> sorted_links(const KeyedGraph& keyed) {
    if (keyed.keys.size() != keyed.graph.vehicle_count()) {
        throw std::invalid_argument("a graph needs one key per vehicle");
    }
    std::vector<LinkKeys> links;
    links.reserve(keyed.graph.link_count());
    for (core::VehicleIndex row = 0; row < keyed.keys.size(); ++row) {
        for (const core::VehicleIndex neighbour : keyed.graph.neighbours_of(row)) {
            if (neighbour < row) continue;
            const auto [low, high] = std::minmax(keyed.keys[row], keyed.keys[neighbour]);
            links.push_back({low, high});
        }
    }
    std::ranges::sort(links);
    return links;
}

}  // namespace

Difference difference(const KeyedGraph& before, const KeyedGraph& after) {
    const std::vector<LinkKeys> old_links = sorted_links(before);
    const std::vector<LinkKeys> new_links = sorted_links(after);
    Difference result;
    std::ranges::set_difference(old_links, new_links, std::back_inserter(result.lost));
    std::ranges::set_difference(new_links, old_links, std::back_inserter(result.added));
    result.kept = old_links.size() - result.lost.size();
    return result;
}

}  // namespace clearway::graph
