#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <sys/types.h>

namespace clearway::core {

/// What a killed process leaves behind has the name of what it was writing and the number of the process:
/// `NAME.PID.clearway-part` (a file), `.NAME.PID.clearway-part` (a folder) and `.NAME.clearway-import-PID`.
/// No file of a user has such a name, so it may be removed wherever it is.
bool is_leftover(const std::filesystem::path& path);

/// The ending of the names of files and folders that are not whole.
inline constexpr const char* part_ending = ".clearway-part";

/// Whether a folder is missing or holds nothing but leftovers and names that are `allowed`. Throws as
/// fail_to_read does: what cannot be listed is not empty.
bool holds_only(const std::filesystem::path& folder, const std::function<bool(const std::string&)>& allowed);
/// Likewise, where hidden names are allowed, such as those of locks.
bool is_absent_or_empty(const std::filesystem::path& folder);

/// Whether it is a leftover whose process is gone.
bool is_abandoned(const std::filesystem::path& path);

/// Whether no process of this machine has that number.
bool is_gone(pid_t process);

/// Removes the leftovers in `folder` whose process is gone. Those of running processes stay.
void remove_abandoned_parts(const std::filesystem::path& folder);

/// Likewise those of `target`, which lie beside it.
void remove_leftovers_of(const std::filesystem::path& target);

/// Writes a file that a user asked for as write_atomically does, after removing the leftovers of it.
void write_output(const std::filesystem::path& file, std::string_view content);

}  // namespace clearway::core
