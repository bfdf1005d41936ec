#pragma once

#include <filesystem>
#include <functional>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// Takes an element of an input file and the file that contains it.
using TakeInput = std::function<void(Element&&, const std::filesystem::path& file)>;

/// Reads a route or additional file as SUMO does: an `<include href="...">`, relative to the including file,
/// is replaced by the elements of that file, and an `<interval>` by its vehicles and persons, whose flows
/// take begin and end from it if they name none. Throws core::InputError as `for_each_element` does, and for
/// files that are missing or include each other in a circle.
void for_each_input(const std::filesystem::path& file, const TakeInput& take);

}  // namespace clearway::scenario_import::detail
