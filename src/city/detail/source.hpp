#pragma once

#include <cstdint>
#include <filesystem>

namespace clearway::city::detail {

/// What a file is, by its content.
enum class SourceKind : std::uint8_t { map, network, configuration, routes, additional };

/// Looks at the beginning of a file, whatever its name, unpacked where it is packed. Throws core::InputError
/// for a file that is missing, empty, or none of these: a web page, an archive, JSON.
SourceKind kind_of(const std::filesystem::path& file);

/// Throws core::InputError for a .gz or .bz2 file that is damaged or unpacks to more than any real file does:
/// over 100 MB and 250 times its size. Reads the file once, without keeping it.
void refuse_bomb(const std::filesystem::path& file);

}  // namespace clearway::city::detail
