#pragma once

#include <filesystem>
#include <string>

namespace clearway::core {

/// `Did you mean './x/parts.toml'?`, from the files beside the missing `file` that have its ending, written
/// as it is; else `otherwise`.
std::string did_you_mean_file(const std::filesystem::path& file, const std::string& otherwise = "");

}  // namespace clearway::core
