#pragma once

#include <cstddef>
#include <vector>

#include "roads/geography.hpp"
#include "roads/network.hpp"
#include "scenario_import/detail/left_out.hpp"

namespace clearway::scenario_import::detail {

/// Leaves out, by street, the signals of a map that no signal of the network stands for: none has a stop line
/// within 50 m. netconvert makes none of those between junctions, such as at crossings for pedestrians.
/// Returns the number of the others.
std::size_t account_for_signals(const std::vector<roads::Coordinates>& signals, const roads::Network& network,
                                LeftOut& left_out);

}  // namespace clearway::scenario_import::detail
