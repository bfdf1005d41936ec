#pragma once

#include <string>
#include <vector>

#include "experiment/settings.hpp"

namespace clearway::experiment {

/// The component of this name, or the components that the policy of this name combines; all for an empty
/// name. Of `preempt_signals.lead_s` the component counts. Throws core::InputError for an unknown name.
std::vector<Component> components_named(const std::string& words);

/// A line for each setting: name, default, unit and allowed values.
std::string settings_lines(const std::vector<Component>& components);
/// Every setting with unit, range, default, meaning and reason, in 80 columns.
std::string settings_console(const std::vector<Component>& components);
/// The parts that a policy combines, and the command that lists the settings of each.
std::string settings_of_parts(const std::string& policy, const std::vector<Component>& parts);
/// The same as a JSON list of objects.
std::string settings_json(const std::vector<Component>& components);
/// The page `docs/reference/settings.md`: one table per component.
std::string settings_markdown(const std::vector<Component>& components);

}  // namespace clearway::experiment
