#pragma once

#include <filesystem>
#include <string>

namespace clearway::scenario::detail {

/// Folder of the scenarios that come with Clearway, found as core::shipped finds files. Throws
/// core::EnvironmentError when there is none.
std::filesystem::path library_folder();

/// The TOML file of a scenario given as file, folder or name. Throws core::InputError naming the nearest
/// known name, or both places where a shipped scenario and one in the working folder have this name.
std::filesystem::path scenario_file(const std::string& name_or_path);

/// Text as a TOML string, quotes included.
std::string quoted(const std::string& text);

}  // namespace clearway::scenario::detail
