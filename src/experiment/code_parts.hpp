#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment/condition.hpp"

namespace clearway::experiment {

/// Makes the names of parts in Python absolute, below `folder`, with the hashes of their files
/// (python::resolved). Throws core::InputError, naming `where`.
void resolve_parts(ConditionSpec& condition, const std::filesystem::path& folder, const std::string& where);

/// The condition with its parts in Python and its model where they are now (python::located_file). Throws
/// core::InputError, naming `where`.
ConditionSpec located(ConditionSpec condition, const std::vector<std::filesystem::path>& folders,
                      const std::string& where);

/// What settings, leases and tables call a part in Python (python::short_name); nothing for other words.
std::optional<std::string> part_called(const std::string& word);
/// The names of the parts in Python that a condition has.
std::vector<std::string> part_names(const ConditionSpec& condition);

}  // namespace clearway::experiment
