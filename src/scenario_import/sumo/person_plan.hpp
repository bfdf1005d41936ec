#pragma once

#include <array>
#include <optional>
#include <string>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// Where a person can walk or ride to and wait, besides edges and lanes. These are elements of additional
/// files, and attributes of `<walk>`, `<ride>` and `<stop>` that name one.
inline constexpr std::array stop_kinds = {"busStop", "trainStop", "containerStop", "chargingStation",
                                          "parkingArea"};

/// The kind of stop that a stage names, or null.
const char* named_stop(const Element& stage);

/// Why a `<person>` or `<personFlow>` does more than walk and ride with vehicles of the files, as words in
/// the plural: `persons who take a taxi`. Nothing for the others.
std::optional<std::string> unsupported_plan(const Element& person);

/// A `<person>` with the plan of one who walks and rides: `<walk>`, `<ride>` and `<stop>` with their relevant
/// attributes; a `<personTrip>` becomes a `<walk>`. Without id, type, departure and parameters.
Element travelling_person(const Element& person);

}  // namespace clearway::scenario_import::detail
