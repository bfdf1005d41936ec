#include "report/detail/changed_ways.hpp"

#include <algorithm>

namespace clearway::report::detail {
namespace {

/// Of edges without a time between two with one: the edge before one that was not seen lacks it, too.
constexpr std::size_t most_missed = 4;

/// The fewest edges that lead from one edge to another, both left out; nothing where they are too many.
std::vector<std::size_t> between(const RoadMap& roads, std::size_t from, std::size_t to) {
    std::vector<std::vector<std::size_t>> open = {{}};
    for (std::size_t missed = 0; missed <= most_missed; ++missed) {
        std::vector<std::vector<std::size_t>> longer;
        for (const std::vector<std::size_t>& way : open) {
            const std::size_t last = way.empty() ? from : way.back();
            for (const std::size_t next : roads.edges[last].to) {
                if (next == to) return way;
                longer.push_back(way);
                longer.back().push_back(next);
            }
        }
        open = std::move(longer);
    }
    return {};
}

void add_edge(const RoadMap& roads, std::size_t edge, DrivenWay& way) {
    if (!way.edges.empty() && way.edges.back() == edge) return;
    if (!way.edges.empty()) {
        const std::vector<std::size_t> missed = between(roads, way.edges.back(), edge);
        way.edges.insert(way.edges.end(), missed.begin(), missed.end());
    }
    way.edges.push_back(edge);
}

bool part(const DrivenWay& one, const DrivenWay& other) {
    const auto [first, second] = std::ranges::mismatch(one.edges, other.edges);
    return first != one.edges.end() && second != other.edges.end();
}

}  // namespace

std::map<std::string, DrivenWay> driven_ways(const metrics::TrafficTables& tables, const EdgePlaces& places,
                                             const RoadMap& roads) {
    std::map<std::string, DrivenWay> ways;
    std::vector<std::string> off_map;
    for (const metrics::EdgeTimeRow& row : tables.edge_times) {
        const auto place = places.find(row.edge);
        if (place == places.end()) {
            off_map.push_back(row.vehicle);
            continue;
        }
        DrivenWay& way = ways[row.vehicle];
        if (way.edges.empty()) way.from_s = row.entered_s;
        add_edge(roads, place->second, way);
        way.to_s = row.entered_s + row.time_s;
    }
    for (const std::string& vehicle : off_map)
        ways.erase(vehicle);
    return ways;
}

void add_changed_ways(const std::map<std::string, DrivenWay>& without,
                      const std::map<std::string, DrivenWay>& with, std::uint32_t replication,
                      ScenarioMap& map) {
    for (const auto& [vehicle, taken] : with) {
        const auto left = without.find(vehicle);
        if (left == without.end()) continue;
        ++map.trips;
        if (!part(left->second, taken)) continue;
        map.changed_ways.push_back({vehicle, replication, left->second.edges, taken.edges,
                                    left->second.to_s - left->second.from_s, taken.to_s - taken.from_s});
    }
}

}  // namespace clearway::report::detail
