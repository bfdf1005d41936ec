#include "scenario_import/osm/sites.hpp"

#include <set>
#include <string>
#include <utility>

#include "roads/geography.hpp"

namespace clearway::scenario_import::detail {

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
        const std::string& edge = network.edge(nearest).id;
        if (taken.emplace(site.kind, edge).second)
            placed.push_back({.kind = site.kind,
                              .edge = edge,
                              .longitude = {},
                              .latitude = {},
                              .name = site.name,
                              .units = {}});
    }
    return placed;
}

}  // namespace clearway::scenario_import::detail
