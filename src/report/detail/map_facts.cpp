#include "report/detail/map_facts.hpp"

#include <map>

#include "report/detail/changed_ways.hpp"
#include "report/overview.hpp"

namespace clearway::report::detail {
namespace {

/// Sums over the replications of two conditions.
struct Sums {
    std::map<std::size_t, EdgeTimes> times;  ///< Sums, not means.
    std::map<std::string, metrics::SignalHoldRow> holds;
    std::map<std::size_t, MapLocks> locks;  ///< By edge.
    std::uint64_t runs = 0;
};

using Passages = std::map<std::pair<std::string, std::string>, double>;

/// By vehicle and edge. A route that passes an edge twice counts its first passage.
Passages passages_of(const metrics::TrafficTables& tables) {
    Passages passages;
    for (const metrics::EdgeTimeRow& row : tables.edge_times)
        passages.emplace(std::pair(row.vehicle, row.edge), row.time_s);
    return passages;
}

void add_locks(const metrics::TrafficTables& tables, const EdgePlaces& edges, std::uint64_t MapLocks::*count,
               Sums& sums) {
    for (const metrics::LockRow& row : tables.locks) {
        const auto edge = edges.find(row.edge);
        if (edge == edges.end()) continue;
        MapLocks& locks = sums.locks[edge->second];
        locks.edge = edge->second;
        ++(locks.*count);
    }
}

void add_pair(const metrics::TrafficTables& without, const metrics::TrafficTables& with,
              const EdgePlaces& edges, Sums& sums) {
    ++sums.runs;
    add_locks(without, edges, &MapLocks::baseline, sums);
    add_locks(with, edges, &MapLocks::condition, sums);
    const Passages baseline = passages_of(without);
    for (const auto& [passage, seconds] : passages_of(with)) {
        const auto edge = edges.find(passage.second);
        const auto same = baseline.find(passage);
        if (edge == edges.end() || same == baseline.end()) continue;
        EdgeTimes& sum = sums.times[edge->second];
        sum.edge = edge->second;
        ++sum.passages;
        sum.baseline_s += same->second;
        sum.condition_s += seconds;
    }
    for (const metrics::SignalHoldRow& row : with.holds) {
        metrics::SignalHoldRow& sum = sums.holds[row.signal];
        sum.holds += row.holds;
        sum.held_s += row.held_s;
    }
}

void fill(const Sums& sums, const RoadMap& roads, ScenarioMap& map) {
    for (auto [edge, times] : sums.times) {
        const auto passages = static_cast<double>(times.passages);
        times.baseline_s /= passages;
        times.condition_s /= passages;
        map.times.push_back(times);
    }
    for (const auto& [edge, locks] : sums.locks)
        map.locks.push_back(locks);
    const auto runs = static_cast<double>(sums.runs);
    for (std::size_t signal = 0; signal < roads.signals.size(); ++signal) {
        const auto held = sums.holds.find(roads.signals[signal].id);
        if (held != sums.holds.end())
            map.holds.push_back(
                {signal, static_cast<double>(held->second.holds) / runs, held->second.held_s / runs});
    }
}

std::vector<std::size_t> station_edges(const RoadMap& roads) {
    std::vector<std::size_t> edges;
    for (const MapStation& station : roads.stations) {
        if (const auto edge = roads.find_edge(station.edge)) edges.push_back(*edge);
    }
    return edges;
}

}  // namespace

std::optional<ScenarioMap> map_in(RunTraffic& traffic, const StudyFacts& study,
                                  const ScenarioFacts& scenario) {
    const ConditionFacts* const condition = featured_condition(study, scenario);
    if (condition == nullptr || !scenario.roads) return std::nullopt;
    const RoadMap& roads = *scenario.roads;
    const ConditionFacts& baseline = *scenario.baseline_of(*condition);
    EdgePlaces edges;
    for (std::size_t edge = 0; edge < roads.edges.size(); ++edge)
        edges[roads.edges[edge].id] = edge;
    Sums sums;
    ScenarioMap map;
    for (std::uint32_t replication = 0; replication < scenario.replications; ++replication) {
        const auto& without = traffic.of({scenario.name, baseline.name(), replication});
        if (without.edge_times.empty()) continue;
        const auto& with = traffic.of({scenario.name, condition->name(), replication});
        if (with.edge_times.empty()) continue;
        add_pair(without, with, edges, sums);
        add_changed_ways(driven_ways(without, edges, roads), driven_ways(with, edges, roads), replication,
                         map);
    }
    if (sums.times.empty()) return std::nullopt;
    map.condition = static_cast<std::size_t>(condition - scenario.conditions.data());
    fill(sums, roads, map);
    map.reach = reach_of(roads, map.times, station_edges(roads),
                         analysis::mean_of(baseline.value(Measure::emergency_restricted_time)).value_or(0.0));
    return map;
}

}  // namespace clearway::report::detail
