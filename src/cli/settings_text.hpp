#pragma once

#include <string>
#include <vector>

#include "experiment/settings.hpp"

namespace clearway::cli {

/// The component of this name, those that a policy combines, or all for an empty name. Throws
/// core::InputError for an unknown one, naming the nearest.
std::vector<experiment::Component> components_named(const std::string& name);

/// Every setting with unit, range, default and reason, in 80 columns.
std::string settings_text(const std::vector<experiment::Component>& components);
/// A list of objects.
std::string settings_json(const std::vector<experiment::Component>& components);
/// The page `docs/reference/settings.md`: a table a component.
std::string settings_markdown(const std::vector<experiment::Component>& components);

}  // namespace clearway::cli
