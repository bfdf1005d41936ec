#pragma once

#include <filesystem>
#include <string_view>

#include <sys/types.h>

namespace clearway::core {

/// What a killed process leaves behind has the name of what it was writing and the number of the process:
/// `NAME.PID.part` (a file), `.NAME.PID.part` (a folder) and `.NAME.importing-PID`.
bool is_leftover(const std::filesystem::path& path);

/// Whether no process of this machine has that number.
bool is_gone(pid_t process);

/// Removes the leftovers of `target`, which lie beside it, whose process is gone. Those of running processes
/// stay. Lists the folder of `target`.
void remove_leftovers_of(const std::filesystem::path& target);

/// Writes a file that a user asked for as write_atomically does, after removing the leftovers of it.
void write_output(const std::filesystem::path& file, std::string_view content);

}  // namespace clearway::core
