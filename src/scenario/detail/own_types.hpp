#pragma once

#include <string>

#include "scenario/config.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::scenario::detail {

/// Id of the SUMO type that vehicles of a class and of `type` of the measured demand get: `human.PKW`.
std::string own_type_id(traffic::VehicleClass vehicle_class, const std::string& type);

/// The `<vType>` elements of `[measured.own_types]`: each listed type as a human one, and cars as automated
/// ones too, which follow by the Intelligent Driver Model without a speed factor. Throws core::InputError for
/// listed types that the file does not define.
std::string own_types_xml(const ScenarioConfig& config);

}  // namespace clearway::scenario::detail
