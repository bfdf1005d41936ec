#pragma once

#include "campaign/equip.hpp"

namespace clearway::campaign::detail {

/// The request with as many seeds as its time allows, if it gives one, by a forecast; says how many on
/// standard error, and whether the fewest take longer. Throws core::InputError where nothing can be forecast.
EquipRequest fitted(EquipRequest request);

}  // namespace clearway::campaign::detail
