#pragma once

#include <vector>

#include "city/detail/demand_reader.hpp"
#include "city/detail/map.hpp"
#include "city/import.hpp"
#include "roads/network.hpp"

namespace clearway::city::detail {

/// Fills what `findings` says of the network.
void survey(const roads::Network& network, Findings& findings);

/// Diagonal of the network's lanes, m.
double diagonal_m(const roads::Network& network);

/// The sites of a map at the nearest edge of the largest car-connected component, within 300 m of its start,
/// end or bends; others are left out and counted. One site for each edge and kind. `minimum_edge_m`: shorter
/// edges are not taken, for trips cannot start there.
std::vector<scenario::EmergencySite> place_sites(const std::vector<MapSite>& sites,
                                                 const roads::Network& network, double minimum_edge_m,
                                                 LeftOut& left_out);

}  // namespace clearway::city::detail
