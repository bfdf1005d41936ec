#pragma once

#include <string_view>

#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/left_out.hpp"

namespace clearway::scenario_import::detail {

/// Kind in `[[measured.type]]` for a vClass: `car` for an empty one, `other` for those without a kind.
const char* kind_of_class(std::string_view vehicle_class);

/// The class of SUMO 1.15 that is nearest to one that only newer releases have; empty for any other class.
std::string_view older_class(std::string_view vehicle_class);

/// Whether a `<vType>` or `<vehicle>` has blue lights: class emergency, the shape of an emergency vehicle, or
/// SUMO's device for them.
bool has_blue_lights(const Element& element);

/// Removes devices from a `<vType>` or `<vehicle>` that would write files into the user's current folder,
/// that need types under their own names, or that are the blue lights of a vehicle which is ordinary traffic
/// here.
void take_out_devices(Element& element, LeftOut& left_out);

}  // namespace clearway::scenario_import::detail
