#pragma once

#include <vector>

#include "roads/network.hpp"
#include "scenario_import/detail/demand_reader.hpp"
#include "scenario_import/detail/map.hpp"
#include "scenario_import/import.hpp"

namespace clearway::scenario_import::detail {

/// Fills what `findings` says of the network.
void survey(const roads::Network& network, Findings& findings);

/// Diagonal of the network's lanes, m.
double diagonal_m(const roads::Network& network);

/// The edges on which trips may start and end. By `trips.ends`, not shorter than `trips.minimum_edge_m`.
std::vector<core::EdgeIndex> trip_edges(const roads::Network& network, const scenario::Trips& trips);

/// The sites of a map at the nearest edge on which such trips may start or end, within 300 m of its start,
/// end or bends; others are left out and counted. One site for each edge and kind.
std::vector<scenario::EmergencySite> place_sites(const std::vector<MapSite>& sites,
                                                 const roads::Network& network, const scenario::Trips& trips,
                                                 LeftOut& left_out);

}  // namespace clearway::scenario_import::detail
