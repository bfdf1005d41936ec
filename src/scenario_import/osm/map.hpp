#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenario_import/import.hpp"
#include "scenario_import/osm/map_contents.hpp"

namespace clearway::scenario_import::detail {

/// What was left of maps, and what is in it.
struct Extract {
    std::filesystem::path file;
    MapContents contents;
};

/// Leaves of maps (several are merged) what an import needs, sorted, as a file in `folder`. Throws
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

/// Builds `network.net.xml` in `folder` of the roads for cars in what was left of `map`, with netconvert.
/// Roads whose limit the map does not say get that of towns, by SUMO's map of types. Throws core::InputError
/// when there are none.
std::filesystem::path build_roads(const std::filesystem::path& map, const std::filesystem::path& extract,
                                  RoadPlan plan, const std::filesystem::path& folder,
                                  const OnProgress& on_progress);

}  // namespace clearway::scenario_import::detail
