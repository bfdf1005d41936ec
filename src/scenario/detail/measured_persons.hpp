#pragma once

#include <string>

#include "scenario/detail/demand.hpp"

namespace clearway::scenario::detail {

/// Route file of the persons of `[measured] persons` who set out in [0, time.window_s], by departure, with
/// their types. Both get `person.` before their ids, persons until none has the id of a vehicle of `demand`:
/// collisions name people and vehicles alike. Throws core::InputError with every person whom SUMO would
/// refuse, or could end a run at.
std::string measured_persons_xml(const DemandContext& context, const PlannedDemand& demand);

}  // namespace clearway::scenario::detail
