#pragma once

#include <filesystem>
#include <string>

namespace clearway::core {

/// `Did you mean './x/parts.toml'?`, from what lies beside the missing file or folder and has its ending,
/// written as it is; else `otherwise`.
std::string did_you_mean_file(const std::filesystem::path& file, const std::string& otherwise = "");

}  // namespace clearway::core
