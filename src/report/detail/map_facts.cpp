#include "report/detail/map_facts.hpp"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "report/overview.hpp"

namespace clearway::report::detail {
namespace {

using nlohmann::json;

MapEdge edge_from(const json& row, std::size_t edges) {
    MapEdge edge;
    row.at("id").get_to(edge.id);
    row.at("to").get_to(edge.to);
    row.at("signal").get_to(edge.signal);
    row.at("length_m").get_to(edge.length_m);
    row.at("limit_mps").get_to(edge.limit_mps);
    const auto numbers = row.at("shape_m").get<std::vector<double>>();
    for (std::size_t at = 0; at + 1 < numbers.size(); at += 2)
        edge.shape.emplace_back(numbers[at], numbers[at + 1]);
    for (const std::size_t next : edge.to) {
        if (next >= edges)
            throw json::other_error::create(501, "an edge leads to one that is not listed", &row);
    }
    return edge;
}

RoadMap roads_from(const json& object) {
    RoadMap map;
    for (const json& row : object.at("edges"))
        map.edges.push_back(edge_from(row, object.at("edges").size()));
    for (const json& row : object.at("signals"))
        map.signals.push_back(
            {row.at("id").get<std::string>(), {row.at("x_m").get<double>(), row.at("y_m").get<double>()}});
    for (const json& row : object.at("stations"))
        map.stations.push_back({row.at("edge").get<std::string>(), row.at("kind").get<std::string>(),
                                row.at("name").get<std::string>()});
    return map;
}

/// Sums over the replications of two conditions.
struct Sums {
    std::map<std::size_t, EdgeTimes> times;  ///< Sums, not means.
    std::map<std::string, metrics::SignalHoldRow> holds;
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

void add_pair(const metrics::TrafficTables& without, const metrics::TrafficTables& with,
              const std::map<std::string, std::size_t>& edges, Sums& sums) {
    ++sums.runs;
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

void fill(const Sums& sums, ScenarioMap& map) {
    for (auto [edge, times] : sums.times) {
        const auto passages = static_cast<double>(times.passages);
        times.baseline_s /= passages;
        times.condition_s /= passages;
        map.times.push_back(times);
    }
    const auto runs = static_cast<double>(sums.runs);
    for (std::size_t signal = 0; signal < map.roads.signals.size(); ++signal) {
        const auto held = sums.holds.find(map.roads.signals[signal].id);
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

std::optional<RoadMap> roads_in(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return std::nullopt;
    try {
        return roads_from(json::parse(core::read_file(file)));
    } catch (const json::exception& error) {
        throw core::InputError(core::Problem{file.string(), error.what(),
                                             "an object with edges, signals and stations",
                                             "Remove the file, or create the run folder again"});
    }
}

std::optional<ScenarioMap> map_in(const results::Store& store, const StudyFacts& study,
                                  const ScenarioFacts& scenario, RoadMap roads) {
    const ConditionFacts* const condition = featured_condition(study, scenario);
    if (condition == nullptr) return std::nullopt;
    const ConditionFacts& baseline = scenario.conditions[*condition->baseline];
    std::map<std::string, std::size_t> edges;
    for (std::size_t edge = 0; edge < roads.edges.size(); ++edge)
        edges[roads.edges[edge].id] = edge;
    Sums sums;
    for (std::uint32_t replication = 0; replication < scenario.replications; ++replication) {
        const auto without = store.read_traffic({scenario.name, baseline.name, replication});
        if (without.edge_times.empty()) continue;
        const auto with = store.read_traffic({scenario.name, condition->name, replication});
        if (!with.edge_times.empty()) add_pair(without, with, edges, sums);
    }
    if (sums.times.empty()) return std::nullopt;
    ScenarioMap map;
    map.roads = std::move(roads);
    map.condition = static_cast<std::size_t>(condition - scenario.conditions.data());
    fill(sums, map);
    map.reach = reach_of(map.roads, map.times, station_edges(map.roads),
                         baseline.outcome(Measure::emergency_restricted_time).value.mean.value_or(0.0));
    return map;
}

}  // namespace clearway::report::detail
