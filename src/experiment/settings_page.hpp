#pragma once

#include <string>
#include <vector>

#include "experiment/settings.hpp"

namespace clearway::experiment {

/// The component of this name, or the components that the policy of this name combines; all for an empty
/// name. Throws core::InputError for an unknown name, suggesting the nearest.
std::vector<Component> components_named(const std::string& name);

/// Every setting with unit, range, default and reason, in 80 columns.
std::string settings_console(const std::vector<Component>& components);
/// The same as a JSON list of objects.
std::string settings_json(const std::vector<Component>& components);
/// The page `docs/reference/settings.md`: one table per component.
std::string settings_markdown(const std::vector<Component>& components);

}  // namespace clearway::experiment
