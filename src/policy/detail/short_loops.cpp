#include "policy/detail/short_loops.hpp"

#include <cstdint>
#include <set>

namespace clearway::policy::detail {
namespace {

/// By signal: the other signals that a short block joins to it, in either direction.
using Neighbours = std::vector<std::set<std::uint32_t>>;

template <class Visit>
void for_each_way(const roads::Network& network, const Visit& visit) {
    for (std::uint32_t row = 0; row < network.signals().size(); ++row)
        for (const auto& ways : network.signal(core::SignalIndex{row}).links)
            for (const roads::SignalLink& way : ways)
                visit(row, way);
}

Neighbours short_blocks(const roads::Network& network, double shorter_than_m) {
    std::vector<std::set<std::uint32_t>> behind(network.edges().size());
    for_each_way(network, [&](std::uint32_t signal, const roads::SignalLink& way) {
        behind[network.lane(way.to).edge.value].insert(signal);
    });
    Neighbours neighbours(network.signals().size());
    for_each_way(network, [&](std::uint32_t signal, const roads::SignalLink& way) {
        const core::EdgeIndex edge = network.lane(way.from).edge;
        if (network.edge(edge).internal || network.edge(edge).length_m >= shorter_than_m) return;
        for (const std::uint32_t before : behind[edge.value]) {
            if (before == signal) continue;
            neighbours[before].insert(signal);
            neighbours[signal].insert(before);
        }
    });
    return neighbours;
}

}  // namespace

std::vector<bool> on_short_loops(const roads::Network& network, double shorter_than_m) {
    Neighbours neighbours = short_blocks(network, shorter_than_m);
    std::vector<std::uint32_t> ends;
    const auto add_if_end = [&](std::uint32_t signal) {
        if (neighbours[signal].size() == 1) ends.push_back(signal);
    };
    for (std::uint32_t signal = 0; signal < neighbours.size(); ++signal)
        add_if_end(signal);
    while (!ends.empty()) {
        const std::uint32_t end = ends.back();
        ends.pop_back();
        for (const std::uint32_t next : neighbours[end]) {
            neighbours[next].erase(end);
            add_if_end(next);
        }
        neighbours[end].clear();
    }
    std::vector<bool> on_loop;
    for (std::uint32_t signal = 0; signal < neighbours.size(); ++signal) {
        if (neighbours[signal].empty()) continue;
        on_loop.resize(neighbours.size());
        on_loop[signal] = true;
    }
    return on_loop;
}

}  // namespace clearway::policy::detail
