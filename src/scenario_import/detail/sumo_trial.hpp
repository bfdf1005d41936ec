#pragma once

#include <string>
#include <vector>

#include "scenario/prepare.hpp"
#include "scenario_import/detail/context.hpp"

namespace clearway::scenario_import::detail {

/// Arguments for `sumo` to run what was prepared, without its end, its step and its outputs.
std::vector<std::string> sumo_arguments(const scenario::Prepared& prepared);

/// A network and its first demand.
struct Tried {
    scenario::BuiltNetwork network;
    scenario::Prepared demand;
};

/// Writes the scenario and builds its network and first demand as a run does, so that what a run would refuse
/// is refused here. Allows shorter trips when the network has none of the wanted length. Throws
/// core::InputError.
Tried make_demand(Import& import, scenario::ScenarioConfig& config);

/// Has SUMO load a demand. Throws core::InputError when it does not.
void require_load(const Import& import, const scenario::Prepared& demand);

/// Runs the demand without EVs at the steps of its SUMO scenario and at those of the import, where these
/// differ, until ten minutes after the last departure, and reports the mean time loss in both: it is not the
/// same. Notes when SUMO fails.
void compare_steps(Import& import, const scenario::Prepared& demand, double own_step_s);

}  // namespace clearway::scenario_import::detail
