#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/ids.hpp"
#include "roads/geography.hpp"
#include "roads/network.hpp"

namespace clearway::scenario {
struct ScenarioConfig;
}

namespace clearway::scenario::detail {

/// A place on a road outside junctions.
struct RoadPlace {
    core::EdgeIndex edge;
    float position_m = 0.0F;
};

/// Where a key of a row is set, `incident[0]` and `edge`; for one that is not set, the row and the key.
std::string place_of_key(const ScenarioConfig& config, const std::string& row, const std::string& key);

/// The middle of an edge; nothing after adding a problem at `where`.
std::optional<RoadPlace> on_edge(const roads::Network& network, const std::string& id,
                                 const std::string& where, std::vector<core::Problem>& problems);

/// The nearest place on a road open to cars, within 100 m; nothing after adding a problem at `where`.
std::optional<RoadPlace> at_coordinates(const roads::Network& network, roads::Coordinates place,
                                        const std::string& where, std::vector<core::Problem>& problems);

/// How the network lies on the globe; nothing after adding a problem at `where`.
std::optional<roads::Geography> geography_of(const roads::Network& network, const std::string& where,
                                             std::vector<core::Problem>& problems);

/// The problem of coordinates that meet no road, in words such as `no road open to cars within 100 m`, with
/// the range of the network's. The network has a projection.
core::Problem no_road_near(const roads::Network& network, roads::Coordinates place, const std::string& where,
                           const std::string& missing);

/// Where `incident[0]` stands; for one without a place, its key edge where that is given, so that one that
/// could not be read is not told twice.
std::string place_of_row(const ScenarioConfig& config, const std::string& row, bool has_place);

/// Adds a problem for a row with neither or both of edge and coordinates, or one coordinate alone.
template <class Row>
void check_edge_or_coordinates(const Row& row, const ScenarioConfig& config, const std::string& key,
                               std::vector<core::Problem>& problems) {
    const bool both = row.longitude && row.latitude;
    const bool any = row.longitude || row.latitude;
    if (any == both && any == row.edge.empty()) return;
    problems.push_back({place_of_row(config, key, any),
                        any && !row.edge.empty() ? "has an edge, and coordinates besides"
                        : any                    ? "has but one of longitude and latitude"
                                                 : "has no place",
                        "edge, or longitude and latitude", "give one of the two"});
}

/// Moves a place along its edge to `position_m`, or adds a problem at `where`.
void move_to(const roads::Network& network, double position_m, const std::string& where, RoadPlace& place,
             std::vector<core::Problem>& problems);

}  // namespace clearway::scenario::detail
