#pragma once

#include <array>
#include <optional>
#include <string>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// Where a person can walk to and wait, besides edges and lanes. These are elements of additional files, and
/// attributes of `<walk>` and `<stop>` that name one.
inline constexpr std::array stop_kinds = {"busStop", "trainStop", "containerStop", "chargingStation",
                                          "parkingArea"};

/// The kind of stop that a `<walk>` or `<stop>` names, or null.
const char* named_stop(const Element& stage);

/// Why a `<person>` or `<personFlow>` does not only walk, as words in the plural: `persons who ride`. Nothing
/// for those who only walk.
std::optional<std::string> reason_not_to_walk(const Element& person);

/// A `<person>` with the plan of one who only walks: `<walk>` and `<stop>` with their relevant attributes; a
/// `<personTrip>` becomes a `<walk>`. Without id, type, departure and parameters.
Element walking_person(const Element& person);

}  // namespace clearway::scenario_import::detail
