#pragma once

#include <cstdint>

#include "scenario/prepare.hpp"
#include "scenario_import/detail/context.hpp"

namespace clearway::scenario_import::detail {

/// Sets how the ends of trips are drawn: where at most half of the car edges reach each other, between any
/// two of which one leads to the other. Throws core::InputError when no edge is long enough for trips.
void choose_trips(Import& import, scenario::ScenarioConfig& config, const roads::Network& network);

/// Gives `config` a demand by recipe: cars that depart evenly over a quarter of an hour, 35 % of them
/// automated, on trips drawn by length of edge (`choose_trips` comes before). Their number is the largest of
/// a ladder (factor 1.5) with which the network is busy but not jammed, tried with SUMO at steps of 1 s: over
/// the minutes 12 to 15, mean speed at least 45 % of the limits, at most 40 % of the vehicles halting, at
/// most 5 % waiting to be let in, at most 1 % teleported. Says in `import.findings` what was found.
void add_synthetic_demand(Import& import, scenario::ScenarioConfig& config, const roads::Network& network);

/// Writes the scenario, builds its network and first demand as a run does, and has SUMO load them: so what a
/// run would refuse is refused here. Shorter trips are allowed when the network has none of the length
/// wanted. Throws core::InputError.
scenario::Prepared try_out(Import& import, scenario::ScenarioConfig& config);

}  // namespace clearway::scenario_import::detail
