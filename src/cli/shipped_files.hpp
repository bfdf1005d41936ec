#pragma once

#include <filesystem>
#include <optional>

namespace clearway::cli {

/// A file or folder of Clearway's source tree, `name` relative to it: below CLEARWAY_HOME where that is set,
/// else in the nearest folder above the program that has it. Nothing when there is none.
std::optional<std::filesystem::path> shipped(const std::filesystem::path& name);

}  // namespace clearway::cli
