#pragma once

#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "scenario_import/import.hpp"

namespace clearway::scenario_import::detail {

/// Fills in what `findings` says about the network.
void survey(const roads::Network& network, Findings& findings);

/// Diagonal of the network's lanes, m.
double diagonal_m(const roads::Network& network);

}  // namespace clearway::scenario_import::detail
