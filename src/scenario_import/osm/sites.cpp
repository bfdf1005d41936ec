#include "scenario_import/osm/sites.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "roads/geography.hpp"
#include "roads/reach.hpp"
#include "scenario_import/detail/survey.hpp"

namespace clearway::scenario_import::detail {

namespace {

using scenario::SiteKind;

constexpr double site_reach_m = 300.0;

struct Nearest {
    core::EdgeIndex edge;
    double metres = std::numeric_limits<double>::infinity();
};

Nearest nearest_edge(const roads::Network& network, const std::vector<core::EdgeIndex>& edges,
                     roads::Point place) {
    Nearest nearest;
    for (const core::EdgeIndex edge : edges) {
        for (const roads::Point& point : network.lane(network.lane_of(edge, 0)).shape) {
            const double metres = std::hypot(point.x_m - place.x_m, point.y_m - place.y_m);
            if (metres < nearest.metres) nearest = {edge, metres};
        }
    }
    return nearest;
}

/// The edges at which sites may lie. If trip ends are only `reachable`, stations need an edge that leads on
/// and hospitals one that can be reached; if the map has only one of the two, its sites need both.
class SiteEdges {
  public:
    SiteEdges(const roads::Network& network, const scenario::Trips& trips, const std::vector<MapSite>& sites)
        : stations_(trip_edges(network, trips)), hospitals_(stations_) {
        if (trips.ends == scenario::TripEnds::connected) return;
        const roads::Reach reach(network);
        const bool has_hospital = std::ranges::any_of(sites, is_hospital);
        const bool has_station = !std::ranges::all_of(sites, is_hospital);
        const auto erase_ends = [&](std::vector<core::EdgeIndex>& edges, roads::Way way) {
            std::erase_if(edges, [&](core::EdgeIndex edge) { return reach.is_end(edge, way); });
        };
        erase_ends(stations_, roads::Way::onward);
        if (!has_hospital) erase_ends(stations_, roads::Way::back);
        erase_ends(hospitals_, roads::Way::back);
        if (!has_station) erase_ends(hospitals_, roads::Way::onward);
    }
    const std::vector<core::EdgeIndex>& of(SiteKind kind) const {
        return kind == SiteKind::hospital ? hospitals_ : stations_;
    }

  private:
    static bool is_hospital(const MapSite& site) { return site.kind == SiteKind::hospital; }

    std::vector<core::EdgeIndex> stations_, hospitals_;
};

}  // namespace

std::vector<scenario::EmergencySite> place_sites(const std::vector<MapSite>& sites,
                                                 const roads::Network& network, const scenario::Trips& trips,
                                                 LeftOut& left_out) {
    std::vector<scenario::EmergencySite> placed;
    const auto geography = roads::Geography::of(network.location());
    if (!geography) return placed;
    const SiteEdges edges(network, trips, sites);
    const std::vector<core::EdgeIndex> all = roads::car_edges(network);
    std::set<std::pair<SiteKind, std::string>> taken;
    for (const MapSite& site : sites) {
        const roads::Point place = geography->point(site.place);
        const Nearest nearest = nearest_edge(network, edges.of(site.kind), place);
        if (nearest.metres > site_reach_m) {
            left_out.add(
                nearest_edge(network, all, place).metres > site_reach_m
                    ? "hospitals or stations away from the roads of the network"
                    : "hospitals or stations at roads where no trip can start or end: other roads do "
                      "not lead there, or back",
                site.name);
            continue;
        }
        const std::string& edge = network.edge(nearest.edge).id;
        if (taken.emplace(site.kind, edge).second) placed.push_back({site.kind, edge, site.name, {}});
    }
    return placed;
}

}  // namespace clearway::scenario_import::detail
