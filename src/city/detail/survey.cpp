#include "city/detail/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

namespace clearway::city::detail {

namespace {

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

}  // namespace

void survey(const roads::Network& network, Findings& findings) {
    for (const roads::Edge& edge : network.edges()) {
        if (edge.internal) continue;
        ++findings.edges;
        const auto lanes = network.lanes().subspan(edge.first_lane, edge.lane_count);
        if (std::ranges::none_of(lanes, &roads::Lane::allows_cars)) continue;
        ++findings.car_edges;
        findings.lanes += lanes.size();
        findings.road_km += edge.length_m / 1000.0;
        findings.lane_km += edge.length_m / 1000.0 * static_cast<double>(lanes.size());
    }
    findings.signals = network.signals().size();
    const std::size_t connected = roads::largest_car_component(network).size();
    if (findings.car_edges > 0)
        findings.connected_share = static_cast<double>(connected) / static_cast<double>(findings.car_edges);
}

double diagonal_m(const roads::Network& network) {
    roads::Point low{1e30F, 1e30F};
    roads::Point high{-1e30F, -1e30F};
    for (const roads::Lane& lane : network.lanes()) {
        for (const roads::Point& point : lane.shape) {
            low = {std::min(low.x_m, point.x_m), std::min(low.y_m, point.y_m)};
            high = {std::max(high.x_m, point.x_m), std::max(high.y_m, point.y_m)};
        }
    }
    return std::hypot(high.x_m - low.x_m, high.y_m - low.y_m);
}

std::vector<scenario::EmergencySite> place_sites(const std::vector<MapSite>& sites,
                                                 const roads::Network& network, double minimum_edge_m,
                                                 LeftOut& left_out) {
    constexpr double reach_m = 300.0;
    std::vector<scenario::EmergencySite> placed;
    const auto geography = roads::Geography::of(network.location());
    if (!geography) return placed;
    std::vector<core::EdgeIndex> edges = roads::largest_car_component(network);
    std::erase_if(edges, [&](core::EdgeIndex edge) { return network.edge(edge).length_m < minimum_edge_m; });
    std::set<std::pair<scenario::SiteKind, std::string>> taken;
    for (const MapSite& site : sites) {
        const Nearest nearest = nearest_edge(network, edges, geography->point(site.place));
        if (nearest.metres > reach_m) {
            left_out.add("hospitals or stations away from the roads of the network", site.name);
            continue;
        }
        const std::string& edge = network.edge(nearest.edge).id;
        if (taken.emplace(site.kind, edge).second) placed.push_back({site.kind, edge, site.name});
    }
    return placed;
}

}  // namespace clearway::city::detail
