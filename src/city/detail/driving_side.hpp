#pragma once

#include <string>

#include "roads/geography.hpp"

namespace clearway::city::detail {

/// The land at a place where traffic drives on the left, empty where it drives on the right. By boxes of
/// about a tenth of a degree, so a place within some 10 km of a border may be told wrong.
std::string left_driving_land(roads::Coordinates place);

}  // namespace clearway::city::detail
