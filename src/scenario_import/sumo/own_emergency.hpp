#pragma once

#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/class_access.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// With OwnEmergency::measure, throws core::InputError if no vehicle with blue lights departs in the window,
/// naming the first that departs at all.
void check_own_emergency(const Import& import, const Demand& demand, const Window& window);

/// What is said of vehicles with blue lights among those of `demand`: a finding if they stay ordinary
/// traffic. With OwnEmergency::measure they leave `demand` and become the emergency vehicles of `config`,
/// with their routes and departures, and the only ones. Call after `config.time` is set; the warm-up then
/// ends before the first of them. Throws core::InputError where the way of each is closed to them, and where
/// there is nothing but them.
void take_own_emergency(Import& import, Demand& demand, const ClassAccess& access, double begin_s,
                        scenario::ScenarioConfig& config);

}  // namespace clearway::scenario_import::detail
