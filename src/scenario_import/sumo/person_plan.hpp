#pragma once

#include <array>
#include <optional>
#include <string>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// What a person can walk to and wait at besides edges and lanes; elements of additional files, and
/// attributes of `<walk>` and `<stop>` that name one.
inline constexpr std::array stop_kinds = {"busStop", "trainStop", "containerStop", "chargingStation",
                                          "parkingArea"};

/// The kind of stop that a `<walk>` or `<stop>` names, or none.
const char* named_stop(const Element& stage);

/// Why a `<person>` or `<personFlow>` is not one who only walks, in words for many of them: `persons who
/// ride`. Nothing for those who do.
std::optional<std::string> reason_not_to_walk(const Element& person);

/// `<person>` with the plan of one who only walks: `<walk>` and `<stop>` with what shapes them, a
/// `<personTrip>` as the `<walk>` that it is. Without id, type, departure and parameters.
Element walking_person(const Element& person);

}  // namespace clearway::scenario_import::detail
