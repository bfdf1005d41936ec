#pragma once

#include "roads/network.hpp"
#include "scenario_import/detail/context.hpp"

namespace clearway::scenario_import::detail {

/// Sets how the ends of trips are drawn: if at most half of the car edges reach each other, any two edges may
/// be drawn of which one leads to the other. Throws core::InputError when no edge is long enough for trips.
void choose_trips(Import& import, scenario::ScenarioConfig& config, const roads::Network& network);

/// Gives `config` a synthetic demand: cars that depart evenly over a quarter of an hour, with the requested
/// share of automated ones, on trips drawn by edge length (call `choose_trips` first), as many as
/// `find_level` finds. Reports the result in `import.findings`.
void add_synthetic_demand(Import& import, scenario::ScenarioConfig& config, const roads::Network& network);

}  // namespace clearway::scenario_import::detail
