#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "roads/geography.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario_import::detail {

/// A hospital or station of a map.
struct MapSite {
    scenario::SiteKind kind = scenario::SiteKind::hospital;
    std::string name;  ///< Or empty. Text from the map.
    roads::Coordinates place;
};

/// How many elements of a map say on which side traffic drives.
struct SideTags {
    std::size_t left = 0;
    std::size_t right = 0;
};

/// What an import wants to know of a map beside its roads.
struct MapContents {
    std::size_t nodes = 0;
    std::size_t roads = 0;       ///< Ways with the tag highway.
    bool is_sorted = true;       ///< Nodes stand before ways, ways before relations.
    roads::Coordinates centre;   ///< Mean of the nodes, the longitude on the circle.
    SideTags sides_of_roads;     ///< Roads with the tag driving_side.
    SideTags sides_of_lands;     ///< Boundaries with that tag.
    double car_roads_km = 0.0;   ///< Ways of the classes that cars drive on.
    double unlimited_km = 0.0;   ///< Of them, those without a limit that netconvert understands.
    std::vector<MapSite> sites;  ///< In the order of the file.
};

/// Reads what `extract_roads` made. Where it is not sorted, sites and lengths of roads are incomplete. Throws
/// core::InputError as core::stream_xml does.
MapContents read_map(const std::filesystem::path& extract);

}  // namespace clearway::scenario_import::detail
