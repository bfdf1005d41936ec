#pragma once

#include <optional>
#include <string>

#include "scenario_import/detail/context.hpp"

namespace clearway::scenario_import::detail {

/// `text` with the user's own names in place of those of the import: places in additional files, ids of
/// types.
std::string in_own_words(std::string text, const Import& import);

/// Where in the user's files the element stands that SUMO complains about, by the id that it names:
/// `stops.add.xml:12`. Nothing when it names none of them.
std::optional<std::string> place_of_complaint(const std::string& complaint, const Import& import);

}  // namespace clearway::scenario_import::detail
