#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace clearway::trace::detail {

/// Bytes that the seal takes at the start of a recording: HDF5's user block, which HDF5 itself never reads.
inline constexpr std::size_t seal_length = 512;

/// Of what is inside a recording: raised when a member, its data set or its meaning changes.
inline constexpr int recording_format = 3;

/// The seal of a file whose HDF5 part is written and closed: format, length and hash of all that follows the
/// seal. So damage is found before HDF5 parses a byte. Throws core::EnvironmentError.
std::string seal_of(const std::filesystem::path& file);

/// Throws core::InputError when `file` is missing, no recording, of another format, cut short or damaged.
void check_seal(const std::filesystem::path& file);

}  // namespace clearway::trace::detail
