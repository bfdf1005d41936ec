#pragma once

#include <string>

#include "scenario/config.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::scenario::detail {

/// Id of the SUMO type for vehicles of this class and of type `type` in the measured demand: `human.PKW`.
std::string own_type_id(traffic::VehicleClass vehicle_class, const std::string& type);

/// The `<vType>` elements of `[measured.own_types]`: each listed type as a human one, and car types also as
/// automated ones, which use the model of the scenario without a speed factor. Throws core::InputError for
/// listed types that the file does not define.
std::string own_types_xml(const ScenarioConfig& config);

}  // namespace clearway::scenario::detail
