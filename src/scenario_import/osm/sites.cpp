#include "scenario_import/osm/sites.hpp"

#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "roads/geography.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// Of a site that the map does not name: where it is, so that people find it.
std::string place_words(const roads::Edge& edge, const roads::Coordinates& place) {
    if (!edge.name.empty()) return "unnamed, " + edge.name;
    return fmt::format("unnamed, latitude {:.4f}, longitude {:.4f}", place.latitude_deg, place.longitude_deg);
}

}  // namespace

std::vector<scenario::EmergencySite> place_sites(const std::vector<MapSite>& sites,
                                                 const roads::Network& network, const scenario::Trips& trips,
                                                 LeftOut& left_out) {
    std::vector<scenario::EmergencySite> placed;
    const auto geography = roads::Geography::of(network.location());
    if (!geography) return placed;
    std::vector<scenario::SiteKind> kinds;
    for (const MapSite& site : sites)
        kinds.push_back(site.kind);
    const scenario::SiteRoads roads(network, trips, kinds);
    std::set<std::pair<scenario::SiteKind, std::string>> taken;
    for (const MapSite& site : sites) {
        const roads::Point place = geography->point(site.place);
        const core::EdgeIndex nearest = roads.nearest(site.kind, place);
        if (!nearest.exists()) {
            left_out.add(
                roads.is_near_road(place)
                    ? "hospitals or stations at roads where no trip can start or end: other roads do "
                      "not lead there, or back"
                    : "hospitals or stations away from the roads of the network",
                site.name);
            continue;
        }
        const roads::Edge& edge = network.edge(nearest);
        if (taken.emplace(site.kind, edge.id).second)
            placed.push_back({.kind = site.kind,
                              .edge = edge.id,
                              .longitude = {},
                              .latitude = {},
                              .name = site.name.empty() ? place_words(edge, site.place) : site.name,
                              .units = {}});
    }
    return placed;
}

}  // namespace clearway::scenario_import::detail
