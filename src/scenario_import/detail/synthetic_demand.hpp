#pragma once

#include "scenario/prepare.hpp"
#include "scenario_import/detail/context.hpp"

namespace clearway::scenario_import::detail {

/// Sets how the ends of trips are drawn: if at most half of the car edges reach each other, any two edges may
/// be drawn of which one leads to the other. Throws core::InputError when no edge is long enough for trips.
void choose_trips(Import& import, scenario::ScenarioConfig& config, const roads::Network& network);

/// Gives `config` a synthetic demand: cars that depart evenly over a quarter of an hour, with the requested
/// share of automated ones, on trips drawn by edge length (call `choose_trips` first). Their number is the
/// largest on a ladder (factor 1.5) with which the network is busy but not jammed, tried with SUMO at steps
/// of 1 s: over minutes 12 to 15, mean speed at least 45 % of the limits, at most 40 % of the vehicles
/// halting, at most 5 % waiting to enter, at most 1 % teleported. Reports the result in `import.findings`.
void add_synthetic_demand(Import& import, scenario::ScenarioConfig& config, const roads::Network& network);

/// Writes the scenario, builds its network and first demand as a run does, and has SUMO load them, so that
/// what a run would refuse is refused here. Allows shorter trips when the network has none of the wanted
/// length. Throws core::InputError.
scenario::Prepared try_out(Import& import, scenario::ScenarioConfig& config);

}  // namespace clearway::scenario_import::detail
