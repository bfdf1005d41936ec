#pragma once

#include <filesystem>
#include <optional>

namespace clearway::core {

/// Finds a file or folder of Clearway's source tree by its relative path: below CLEARWAY_HOME if that is set,
/// else in the nearest parent folder of the program that has it, itself (a source tree) or in share/clearway
/// (an installation). Nothing when there is none.
std::optional<std::filesystem::path> shipped(const std::filesystem::path& name);

}  // namespace clearway::core
