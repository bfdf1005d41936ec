#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace clearway::core {

/// Writes `content` to `file` so that a reader meets the old file or the whole new one, never a part: an
/// AtomicFile. Throws EnvironmentError (folder not writable, disk full) and then leaves `file` as it was.
void write_atomically(const std::filesystem::path& file, std::string_view content);

/// The whole file. Throws InputError when it is missing or unreadable.
std::string read_file(const std::filesystem::path& file);

/// Waits until the names in `folder` are on the disk, so that a rename survives the loss of power. Does
/// nothing on file systems that cannot. Throws EnvironmentError when the folder is not there.
void flush_folder(const std::filesystem::path& folder);

/// Makes a folder and its parents. Throws EnvironmentError naming the folder when that is not possible or not
/// writable.
void make_folder(const std::filesystem::path& folder);

/// 128-bit content hash as 32 hex digits (XXH3). For identity, not for security.
std::string content_hash(std::string_view bytes);

}  // namespace clearway::core
