#pragma once

#include <filesystem>
#include <string>

#include "experiment/condition.hpp"

namespace clearway::experiment {

/// Makes the names of parts in Python absolute, below `folder`, with the hashes of their files
/// (python::resolved). Throws core::InputError, naming `where`.
void resolve_parts(ConditionSpec& condition, const std::filesystem::path& folder, const std::string& where);

}  // namespace clearway::experiment
