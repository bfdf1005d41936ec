#include "report/detail/map_facts.hpp"

#include <map>
#include <numeric>

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

void add_considered(const metrics::TrafficTables& tables, const EdgePlaces& edges, std::uint32_t replication,
                    ScenarioMap& map) {
    for (const metrics::ConsideredRow& row : tables.considered) {
        const auto edge = edges.find(row.edge);
        if (edge != edges.end())
            map.considered.push_back({row.vehicle, replication, edge->second, row.decisions});
    }
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

/// The last edge of a vehicle and the time at its end, and whether it drove past a signal.
struct TripEnd {
    std::string edge;
    double at_s = 0.0;
    bool passes_signal = false;
    bool is_at_signal = false;  ///< The last edge ends at one.
};

std::map<std::string, TripEnd> ends_of(const metrics::TrafficTables& tables, const EdgePlaces& edges,
                                       const RoadMap& roads) {
    std::map<std::string, TripEnd> ends;
    for (const metrics::EdgeTimeRow& row : tables.edge_times) {
        TripEnd& end = ends[row.vehicle];
        if (row.entered_s + row.time_s < end.at_s) continue;
        const auto edge = edges.find(row.edge);
        end.passes_signal = end.passes_signal || end.is_at_signal;
        end.edge = row.edge;
        end.at_s = row.entered_s + row.time_s;
        end.is_at_signal = edge != edges.end() && roads.edges[edge->second].signal;
    }
    return ends;
}

void add_mean(const std::vector<double>& changes_s, LaterArrivals& to) {
    if (changes_s.empty()) return;
    to.trips += changes_s.size();
    to.means_s.push_back(std::reduce(changes_s.begin(), changes_s.end()) /
                         static_cast<double>(changes_s.size()));
}

/// Adds the trips of a pair of runs that end on the same edge in both.
void add_trips(const std::map<std::string, TripEnd>& without, const std::map<std::string, TripEnd>& with,
               SignalTrips& trips) {
    std::vector<double> passing_s;
    std::vector<double> others_s;
    for (const auto& [vehicle, end] : with) {
        const auto before = without.find(vehicle);
        if (before == without.end() || before->second.edge != end.edge) continue;
        const bool passes = end.passes_signal || before->second.passes_signal;
        (passes ? passing_s : others_s).push_back(end.at_s - before->second.at_s);
    }
    add_mean(passing_s, trips.passing);
    add_mean(others_s, trips.others);
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
        add_trips(ends_of(without, edges, roads), ends_of(with, edges, roads), map.signal_trips);
        add_changed_ways(driven_ways(without, edges, roads), driven_ways(with, edges, roads), replication,
                         map);
        add_considered(with, edges, replication, map);
    }
    if (sums.times.empty()) return std::nullopt;
    map.condition = condition->name();
    fill(sums, roads, map);
    map.reach = reach_of(roads, map.times, station_edges(roads),
                         analysis::mean_of(baseline.value(Measure::emergency_restricted_time)).value_or(0.0));
    return map;
}

}  // namespace clearway::report::detail
