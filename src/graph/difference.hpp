#pragma once

#include <span>
#include <vector>

#include "core/ids.hpp"
#include "graph/proximity.hpp"

namespace clearway::graph {

/// A link by the keys of its ends, the smaller first.
struct LinkKeys {
    core::VehicleKey low;
    core::VehicleKey high;
    auto operator<=>(const LinkKeys&) const = default;
};

/// The links in which two graphs differ. Vehicles are compared by key, so their rows do not matter.
struct Difference {
    std::vector<LinkKeys> lost;   ///< Only in the first graph, ascending.
    std::vector<LinkKeys> added;  ///< Only in the second graph, ascending.
    std::size_t kept = 0;         ///< Links in both.
};

/// A graph and the keys of its rows, each key once.
struct KeyedGraph {
    const ProximityGraph& graph;
    std::span<const core::VehicleKey> keys;
};

/// Compares two graphs by key: O(links log links). A vehicle may be in only one graph; its links are then
/// lost or added. Throws std::invalid_argument when a graph and its keys differ in length. Allocates.
Difference difference(const KeyedGraph& before, const KeyedGraph& after);

}  // namespace clearway::graph
