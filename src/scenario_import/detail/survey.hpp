#pragma once

#include <vector>

#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "scenario_import/import.hpp"

namespace clearway::scenario_import::detail {

/// Fills in what `findings` says about the network.
void survey(const roads::Network& network, Findings& findings);

/// Diagonal of the network's lanes, m.
double diagonal_m(const roads::Network& network);

/// The edges on which trips may start and end, as `trips.ends` and `trips.minimum_edge_m` say.
std::vector<core::EdgeIndex> trip_edges(const roads::Network& network, const scenario::Trips& trips);

}  // namespace clearway::scenario_import::detail
