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

/// What separates two graphs, whatever rows their vehicles have in each.
struct Difference {
    std::vector<LinkKeys> lost;   ///< In the first graph alone, ascending.
    std::vector<LinkKeys> added;  ///< In the second graph alone, ascending.
    std::size_t kept = 0;         ///< Links in both.
};

/// A graph and the keys of its rows, each key once.
struct KeyedGraph {
    const ProximityGraph& graph;
    std::span<const core::VehicleKey> keys;
};

/// Compares two graphs by key: O(links log links). A vehicle that only one graph has is no error; its links
/// are lost or added. Throws std::invalid_argument when a graph and its keys differ in length. Allocates.
Difference difference(const KeyedGraph& before, const KeyedGraph& after);

}  // namespace clearway::graph
