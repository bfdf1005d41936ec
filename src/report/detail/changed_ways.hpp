#pragma once

#include <map>
#include <string>
#include <vector>

#include "metrics/traffic_tables.hpp"
#include "report/map.hpp"

namespace clearway::report::detail {

/// Places in RoadMap::edges by id.
using EdgePlaces = std::map<std::string, std::size_t>;

/// Where an emergency vehicle drove, and from when to when it was seen there.
struct DrivenWay {
    std::vector<std::size_t> edges;  ///< In RoadMap::edges, in driving order.
    double from_s = 0.0;
    double to_s = 0.0;
};

/// By vehicle. Short edges that were passed between two steps have no time; they are filled in where the map
/// leads over few edges from one with a time to the next. Vehicles on edges that the map lacks are left out.
std::map<std::string, DrivenWay> driven_ways(const metrics::TrafficTables& tables, const EdgePlaces& places,
                                             const RoadMap& roads);

/// Adds the vehicles of a replication that drove two ways: those that part before either run ended.
void add_changed_ways(const std::map<std::string, DrivenWay>& without,
                      const std::map<std::string, DrivenWay>& with, std::uint32_t replication,
                      ScenarioMap& map);

}  // namespace clearway::report::detail
