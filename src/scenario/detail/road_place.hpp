#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/ids.hpp"
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
std::optional<RoadPlace> at_coordinates(const roads::Network& network, double longitude, double latitude,
                                        const std::string& where, std::vector<core::Problem>& problems);

/// Moves a place along its edge to `position_m`, or adds a problem at `where`.
void move_to(const roads::Network& network, double position_m, const std::string& where, RoadPlace& place,
             std::vector<core::Problem>& problems);

}  // namespace clearway::scenario::detail
