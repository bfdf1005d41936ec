#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace clearway::core {

/// Writes `content` to `file` through an AtomicFile: a reader sees the old file or the whole new one. Throws
/// EnvironmentError (folder not writable, disk full) and then leaves `file` unchanged.
void write_atomically(const std::filesystem::path& file, std::string_view content);

/// The whole file. Throws as fail_to_read: InputError when it is missing or may not be read, EnvironmentError
/// when the machine fails.
std::string read_file(const std::filesystem::path& file);

/// Flushes the directory entries of `folder` to the disk, so that a rename survives a power failure. Does
/// nothing on file systems which do not support this. Throws EnvironmentError when the folder does not exist.
void flush_folder(const std::filesystem::path& folder);

/// Makes a folder and its parents. Throws EnvironmentError naming the folder when it cannot be made or is not
/// writable.
void make_folder(const std::filesystem::path& folder);

/// 128-bit content hash as 32 hex digits (XXH3). For identity, not for security.
std::string content_hash(std::string_view bytes);

}  // namespace clearway::core
