#include "roads/short_loops.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>

namespace clearway::roads {
namespace {

/// By place of signals: the other places that a short block joins to it, in either direction.
using Neighbours = std::vector<std::set<std::uint32_t>>;

template <class Visit>
void for_each_way(const Network& network, const Visit& visit) {
    for (std::uint32_t row = 0; row < network.signals().size(); ++row)
        for (const auto& ways : network.signal(core::SignalIndex{row}).links)
            for (const SignalLink& way : ways)
                visit(row, way);
}

/// The one edge to which cars go on from `edge` without turning round; none where there are several or none.
core::EdgeIndex only_way_on(const Network& network, core::EdgeIndex edge) {
    core::EdgeIndex next;
    for (std::uint32_t number = 0; number < network.edge(edge).lane_count; ++number)
        for (const Connection& way : network.connections_from(network.lane_of(edge, number))) {
            if (!way.allows_cars || way.direction == 't') continue;
            const core::EdgeIndex to = network.lane(way.to).edge;
            if (next.exists() && next != to) return {};
            next = to;
        }
    return next;
}

/// Visits the places of signals at which the block ends that begins with `edge`.
template <class Visit>
void for_each_end(const Network& network, const std::vector<std::set<std::uint32_t>>& ahead,
                  core::EdgeIndex edge, double shorter_than_m, const Visit& visit) {
    std::set<core::EdgeIndex> passed;
    double length_m = 0.0;
    while (edge.exists() && !network.edge(edge).internal && passed.insert(edge).second) {
        length_m += network.edge(edge).length_m;
        if (length_m >= shorter_than_m) return;
        if (!ahead[edge.value].empty()) {
            for (const std::uint32_t signal : ahead[edge.value])
                visit(signal);
            return;
        }
        edge = only_way_on(network, edge);
    }
}

/// Where a signal stands: the mean of its stop lines. No number for one without links.
Point centre_of(const Network& network, std::uint32_t signal) {
    Point sum;
    float count = 0.0F;
    for (const auto& ways : network.signal(core::SignalIndex{signal}).links)
        for (const SignalLink& way : ways) {
            const Point end = network.lane(way.from).shape.back();
            sum = {sum.x_m + end.x_m, sum.y_m + end.y_m};
            ++count;
        }
    return {sum.x_m / count, sum.y_m / count};
}

/// By signal, the first of those that stand at the same place as it: the carriageways of one street.
std::vector<std::uint32_t> places_of(const Network& network) {
    constexpr float same_place_m = 25.0F;
    const auto count = static_cast<std::uint32_t>(network.signals().size());
    std::vector<Point> centres;
    for (std::uint32_t signal = 0; signal < count; ++signal)
        centres.push_back(centre_of(network, signal));
    std::vector<std::uint32_t> places(count);
    std::iota(places.begin(), places.end(), 0U);
    const auto first_of = [&](std::uint32_t signal) {
        while (places[signal] != signal)
            signal = places[signal];
        return signal;
    };
    for (std::uint32_t signal = 0; signal < count; ++signal)
        for (std::uint32_t before = 0; before < signal; ++before) {
            const float x_m = centres[signal].x_m - centres[before].x_m;
            const float y_m = centres[signal].y_m - centres[before].y_m;
            if (std::hypot(x_m, y_m) < same_place_m) {
                const auto [first, second] = std::minmax({first_of(before), first_of(signal)});
                places[second] = first;
            }
        }
    for (std::uint32_t& place : places)
        place = first_of(place);
    return places;
}

Neighbours short_blocks(const Network& network, double shorter_than_m,
                        const std::vector<std::uint32_t>& places) {
    std::vector<std::set<std::uint32_t>> ahead(network.edges().size());
    std::vector<std::set<core::EdgeIndex>> behind(network.signals().size());
    for_each_way(network, [&](std::uint32_t signal, const SignalLink& way) {
        ahead[network.lane(way.from).edge.value].insert(places[signal]);
        behind[places[signal]].insert(network.lane(way.to).edge);
    });
    Neighbours neighbours(network.signals().size());
    for (std::uint32_t before = 0; before < behind.size(); ++before)
        for (const core::EdgeIndex edge : behind[before])
            for_each_end(network, ahead, edge, shorter_than_m, [&](std::uint32_t signal) {
                if (signal == before) return;
                neighbours[before].insert(signal);
                neighbours[signal].insert(before);
            });
    return neighbours;
}

}  // namespace

std::vector<bool> on_short_loops(const Network& network, double shorter_than_m) {
    const std::vector<std::uint32_t> places = places_of(network);
    Neighbours neighbours = short_blocks(network, shorter_than_m, places);
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
        if (neighbours[places[signal]].empty()) continue;
        on_loop.resize(neighbours.size());
        on_loop[signal] = true;
    }
    return on_loop;
}

}  // namespace clearway::roads
