#pragma once

#include <filesystem>
#include <functional>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// Takes an element of an input file and the file that it stands in.
using TakeInput = std::function<void(Element&&, const std::filesystem::path& file)>;

/// Reads a route or additional file as SUMO does: the files that `<include href="...">` names, relative to
/// the including file, stand in its place; the vehicles and persons of an `<interval>` stand in its place
/// too, and its times are the begin and end of those flows that name none. Throws core::InputError as
/// `for_each_element` does, and for files that are missing or include each other in a circle.
void for_each_input(const std::filesystem::path& file, const TakeInput& take);

}  // namespace clearway::scenario_import::detail
