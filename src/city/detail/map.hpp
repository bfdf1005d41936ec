#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "city/import.hpp"
#include "roads/geography.hpp"

namespace clearway::city::detail {

/// A hospital or station of a map.
struct MapSite {
    scenario::SiteKind kind = scenario::SiteKind::hospital;
    std::string name;  ///< Or empty. Text from the map.
    roads::Coordinates place;
};

/// What an import wants to know of a map beside its roads.
struct MapContents {
    std::size_t roads = 0;       ///< Ways with the tag highway.
    roads::Coordinates centre;   ///< Mean of the nodes of the roads.
    std::string driving_side;    ///< `left` or `right` where the map itself says so.
    std::vector<MapSite> sites;  ///< In the order of the file.
};

/// Leaves of maps (several are merged) what an import needs, as `extract.osm` in `folder`. Throws
/// core::InputError for damaged files and for maps without roads.
std::filesystem::path extract_roads(const std::vector<std::filesystem::path>& maps,
                                    const std::filesystem::path& folder, const OnProgress& on_progress);

/// Reads what `extract_roads` made.
MapContents read_map(const std::filesystem::path& extract);

/// Whether roads get sidewalks and crossings.
enum class Footways : std::uint8_t { none, build };

/// How roads are built.
struct RoadPlan {
    DrivingSide side = DrivingSide::right;
    Footways footways = Footways::none;
};

/// Builds `network.net.xml` in `folder` of the roads for cars in what was left of `map`, with netconvert.
/// Throws core::InputError when there are none.
std::filesystem::path build_roads(const std::filesystem::path& map, const std::filesystem::path& extract,
                                  RoadPlan plan, const std::filesystem::path& folder,
                                  const OnProgress& on_progress);

}  // namespace clearway::city::detail
