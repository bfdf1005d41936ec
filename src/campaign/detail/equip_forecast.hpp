#pragma once

#include "campaign/equip.hpp"
#include "scenario/network.hpp"

namespace clearway::campaign::detail {

/// The request with as many seeds as its time allows, if it gives one, by a forecast; says how many on
/// standard error, and whether the fewest take longer. Its commands then name that number. Throws
/// core::InputError where nothing can be forecast.
EquipRequest fitted(EquipRequest request, const scenario::BuiltNetwork& built);

}  // namespace clearway::campaign::detail
