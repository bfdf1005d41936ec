#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace clearway::scenario_import::detail {

/// What a file is, by its content.
enum class SourceKind : std::uint8_t { map, network, configuration, routes, additional };

/// Looks at the beginning of a file, whatever its name, unpacked where it is packed. Throws core::InputError
/// for a file that is missing, empty, or none of these: a web page, an archive, JSON.
SourceKind kind_of(const std::filesystem::path& file);

/// Of a map, the end of a name by which osmium knows it: `osm`, `osm.gz`, `osm.bz2` or `osm.pbf`, by content.
/// Throws core::InputError for a PBF that is packed once more.
std::string map_format(const std::filesystem::path& map);

/// What Overpass says at the end of a map that it could not finish, for example that the query timed out;
/// empty where it says nothing.
std::string overpass_remark(const std::filesystem::path& map);

/// Throws core::InputError for a .gz or .bz2 file that is damaged or unpacks to more than any real file does:
/// over 100 MB and 250 times its size. Reads the file once, without keeping it.
void refuse_bomb(const std::filesystem::path& file);

}  // namespace clearway::scenario_import::detail
