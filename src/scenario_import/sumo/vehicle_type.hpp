#pragma once

#include <string>
#include <string_view>

#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/left_out.hpp"

namespace clearway::scenario_import::detail {

/// Kind of `[[measured.type]]` of a vClass: `car` for an empty one, `other` for those with no kind.
const char* kind_of_class(std::string_view vehicle_class);

/// The class of SUMO 1.15 nearest to one that only newer releases have; empty for any other.
std::string_view older_class(std::string_view vehicle_class);

/// Whether a `<vType>` or `<vehicle>` has blue lights: class emergency, or SUMO's device for them.
bool has_blue_lights(const Element& element);

/// Takes devices out of a `<vType>` or `<vehicle>` that would write files into the folder of whoever runs the
/// scenario, need types under their own names, or are the blue lights of a vehicle that is ordinary traffic
/// here.
void take_out_devices(Element& element, LeftOut& left_out);

}  // namespace clearway::scenario_import::detail
