#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
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

/// Number of map elements that are tagged with a driving side.
struct SideTags {
    std::size_t left = 0;
    std::size_t right = 0;
};

/// What an import needs from a map besides its roads.
struct MapContents {
    std::size_t nodes = 0;
    std::size_t roads = 0;      ///< Ways with the tag highway.
    bool is_sorted = true;      ///< Nodes come before ways, ways before relations.
    roads::Coordinates centre;  ///< Mean of the nodes, the longitude on the circle.
    SideTags sides_of_roads;    ///< Roads with the tag driving_side.
    SideTags sides_of_lands;    ///< Boundaries with that tag.
    double car_roads_km = 0.0;  ///< Ways of the classes that cars drive on.
    double unlimited_km = 0.0;  ///< Of these, those without a limit that netconvert understands.
    std::set<std::string> unlimited_classes;  ///< Their values of the tag highway.
    std::string newest;          ///< Day on which an object was last changed, `2012-05-03`; or empty.
    std::vector<MapSite> sites;  ///< In the order of the file.
    std::vector<roads::Coordinates> signals;  ///< Nodes with highway=traffic_signals: one or more a junction.
};

/// Reads the file of `extract_roads`. If it is not sorted, sites and road lengths are incomplete. Throws
/// core::InputError as core::stream_xml does.
MapContents read_map(const std::filesystem::path& extract);

}  // namespace clearway::scenario_import::detail
