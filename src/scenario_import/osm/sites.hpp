#pragma once

#include <vector>

#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "scenario_import/detail/left_out.hpp"
#include "scenario_import/osm/map.hpp"

namespace clearway::scenario_import::detail {

/// Places the sites of a map at the nearest edge on which such trips may start or end, if its start, end or a
/// bend is within 300 m; others are left out and counted. One site per edge and kind. Those that the map does
/// not name have their street or place as a name.
std::vector<scenario::EmergencySite> place_sites(const std::vector<MapSite>& sites,
                                                 const roads::Network& network, const scenario::Trips& trips,
                                                 LeftOut& left_out);

}  // namespace clearway::scenario_import::detail
