#pragma once

#include <filesystem>

#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// Writes the persons of `demand` who depart in the window into persons.rou.xml of the scenario, by
/// departure, with their types and times from its begin, and names it in `config`. Of a plan what comes after
/// the horizon of `config` is cut. Does nothing where nobody walks. Needs the demand that
/// `take_out_bad_persons` leaves.
void add_persons(Import& import, Demand& demand, const roads::Network& network, const Window& window,
                 scenario::ScenarioConfig& config);

}  // namespace clearway::scenario_import::detail
