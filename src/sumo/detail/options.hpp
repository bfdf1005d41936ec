#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sumo/session.hpp"

namespace clearway::sumo::detail {

inline constexpr const char* trip_file = "tripinfo.xml";
inline constexpr const char* log_file = "sumo.log";

/// Throws core::InputError with every range or extra argument of `config` that cannot work.
void check(const SessionConfig& config);

/// Makes `folder`, returns its canonical path and checks that the trip table can be written there, because
/// with an unwritable output SUMO crashes (segmentation fault). Throws core::EnvironmentError.
std::filesystem::path prepare_folder(const std::filesystem::path& folder);

/// SUMO's arguments, without the name of the program. An extra argument replaces the default of the same
/// name.
std::vector<std::string> arguments(const SessionConfig& config);

/// Sets SUMO_HOME to the installation that was found at build time, unless the user has set it.
void set_sumo_home();

}  // namespace clearway::sumo::detail
