#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace clearway::trace::detail {

/// Size of the seal at the start of a recording, bytes. It fills HDF5's user block, which HDF5 itself never
/// reads.
inline constexpr std::size_t seal_length = 512;

/// Version of the recording format: raised when a member, its data set or its meaning changes.
inline constexpr int recording_format = 6;

/// The seal of a file whose HDF5 part is written and closed: format, length and hash of everything after the
/// seal. It reveals damage before HDF5 parses a byte. Throws core::EnvironmentError.
std::string seal_of(const std::filesystem::path& file);

/// Throws core::InputError when `file` is missing, is not a recording, has another format, or is cut short or
/// damaged.
void check_seal(const std::filesystem::path& file);

}  // namespace clearway::trace::detail
