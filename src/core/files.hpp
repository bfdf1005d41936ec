#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace clearway::core {

/// Writes `content` to `file` so that a reader meets the old file or the whole new one, never a part: written
/// aside, fsync, renamed. Throws EnvironmentError (folder not writable, disk full) and then leaves `file` as
/// it was.
void write_atomically(const std::filesystem::path& file, std::string_view content);

/// The whole file. Throws InputError when it is missing or unreadable.
std::string read_file(const std::filesystem::path& file);

/// Makes a folder and its parents. Throws EnvironmentError naming the folder when that is not possible or not
/// writable.
void make_folder(const std::filesystem::path& folder);

/// 128-bit content hash as 32 hex digits (XXH3). For identity, not for security.
std::string content_hash(std::string_view bytes);

}  // namespace clearway::core
