#pragma once

#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// Writes the persons of `demand` who depart in the window into persons.rou.xml of the scenario, by
/// departure, with their types and with times from its begin, and names the file in `config`. Plans are cut
/// at the horizon of `config`. Does nothing if nobody walks. Call `take_out_bad_persons` first.
void add_persons(Import& import, Demand& demand, const roads::Network& network, const Window& window,
                 scenario::ScenarioConfig& config);

}  // namespace clearway::scenario_import::detail
