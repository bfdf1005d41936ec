#pragma once

#include <string>

#include "scenario/detail/demand.hpp"

namespace clearway::scenario::detail {

/// Route file of the persons of `[measured] persons` who depart in [0, time.window_s], by departure, with
/// their types. All ids get the prefix `person.`; a person's id gets it repeatedly until no vehicle of
/// `demand` has that id, because collisions name persons and vehicles alike. Throws core::InputError with
/// every person whom SUMO would reject or who could crash it.
std::string measured_persons_xml(const DemandContext& context, const PlannedDemand& demand);

}  // namespace clearway::scenario::detail
