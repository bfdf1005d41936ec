#pragma once

#include <vector>

#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// Leaves out the persons of the window who ride but for whom no vehicle of `demand` stops where they get on
/// and then where they get off; `additional` has the places of stops. Reports the vehicles whose passengers
/// are left out.
void check_rides(Import& import, Demand& demand, const std::vector<Element>& additional,
                 const Window& window);

/// Writes the persons of `demand` who depart in the window into persons.rou.xml of the scenario, by
/// departure, with their types and with times from its begin, and names the file in `config`. Plans are cut
/// at the horizon of `config`. Does nothing if there are none. Call `take_out_bad_persons` and `check_rides`
/// first.
void add_persons(Import& import, Demand& demand, const roads::Network& network, const Window& window,
                 scenario::ScenarioConfig& config);

}  // namespace clearway::scenario_import::detail
