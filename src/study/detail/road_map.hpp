#pragma once

#include <string>

#include "roads/network.hpp"
#include "scenario/config.hpp"

namespace clearway::study::detail {

/// `roads.json`: the edges outside junctions that an emergency vehicle may drive, as the report draws them
/// and as it finds ways along them, with the signals and the stations of emergency vehicles.
///
///     {"edges": [{"id": "a", "to": [3, 7], "signal": true, "length_m": 120.5, "limit_mps": 13.89,
///                 "shape_m": [x, y, x, y, ...]}],
///      "signals": [{"id": "J", "x_m": 1.0, "y_m": 2.0}],
///      "stations": [{"edge": "a", "kind": "fire_station", "name": "Fire station 3"}]}
///
/// `to`: places in `edges` of those that an edge leads to. `signal`: whether it ends at one. Places are those
/// of the network, rounded to 0.1 m. Stations are hospitals where the scenario has no others.
std::string road_map_json(const roads::Network& network, const scenario::ScenarioConfig& config);

}  // namespace clearway::study::detail
