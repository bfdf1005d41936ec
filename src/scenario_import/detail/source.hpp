#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace clearway::scenario_import::detail {

/// The kind of a file, by its content.
enum class SourceKind : std::uint8_t { map, network, configuration, routes, additional };

/// Looks at the beginning of a file, unpacked if necessary; its name hardly matters. Throws core::InputError
/// for a file that is missing, empty, or of no such kind: a web page, an archive, JSON.
SourceKind kind_of(const std::filesystem::path& file);

/// The file name extension by which osmium recognises a map (`osm`, `osm.gz`, `osm.bz2` or `osm.pbf`), by
/// content. Throws core::InputError for a PBF file that is compressed again.
std::string map_format(const std::filesystem::path& map);

/// What Overpass says at the end of a map that it could not finish, for example that the query timed out;
/// empty if there is no remark.
std::string overpass_remark(const std::filesystem::path& map);

/// The day of the data as the beginning of a map in XML says, `2012-05-03`; or empty.
std::string stated_map_date(const std::filesystem::path& map);

/// Throws core::InputError for a .gz or .bz2 file that is damaged or unpacks to more than any real file does:
/// over 100 MB and 250 times its size. Reads the file once, without keeping it.
void refuse_bomb(const std::filesystem::path& file);

}  // namespace clearway::scenario_import::detail
