#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenario_import/import.hpp"
#include "scenario_import/osm/map_contents.hpp"

namespace clearway::scenario_import::detail {

/// The extract of the maps, and its contents.
struct Extract {
    std::filesystem::path file;
    MapContents contents;
};

/// Extracts from maps (several are merged) what an import needs, sorted, into a file in `folder`. Throws
/// core::InputError for damaged files and for maps without roads or without nodes.
Extract extract_roads(const std::vector<std::filesystem::path>& maps, const std::filesystem::path& folder,
                      const OnProgress& on_progress);

/// Whether roads get sidewalks and crossings.
enum class Footways : std::uint8_t { none, build };

/// How roads are built.
struct RoadPlan {
    DrivingSide side = DrivingSide::right;
    Footways footways = Footways::none;
};

/// Builds `network.net.xml` in `folder` with netconvert, from the roads for cars in the `extract` of `map`.
/// Roads without a speed limit get the one for towns from SUMO's type map. Throws core::InputError when there
/// are no such roads.
std::filesystem::path build_roads(const std::filesystem::path& map, const std::filesystem::path& extract,
                                  RoadPlan plan, const std::filesystem::path& folder,
                                  const OnProgress& on_progress);

}  // namespace clearway::scenario_import::detail
