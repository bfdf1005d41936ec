#include "scenario/site.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "roads/geography.hpp"
#include "roads/reach.hpp"
#include "scenario/config.hpp"
#include "scenario/detail/road_place.hpp"

namespace clearway::scenario {
namespace {

bool is_hospital(SiteKind kind) {
    return kind == SiteKind::hospital;
}

/// Those of flows lead anywhere; `[trips]` does not speak of them.
Trips trips_of(const ScenarioConfig& config) {
    Trips trips = config.trips;
    if (config.demand_kind() == DemandKind::flows) trips.ends = TripEnds::reachable;
    return trips;
}

}  // namespace

traffic::EmergencyEnds emergency_ends(const ScenarioConfig& config) {
    const auto has = [&](SiteKind kind) {
        return std::ranges::any_of(config.emergency_sites,
                                   [&](const auto& site) { return site.kind == kind; });
    };
    return {.hospitals = has(SiteKind::hospital),
            .ambulance_stations = has(SiteKind::ambulance_station),
            .fire_stations = has(SiteKind::fire_station),
            .ambulances = config.emergency_kinds.ambulance > 0.0,
            .fire_engines = config.emergency_kinds.fire_engine > 0.0,
            .police_cars = config.emergency_kinds.police_car > 0.0,
            .least_m = config.trips.emergency_minimum_length_m};
}

std::vector<core::EdgeIndex> trip_edges(const roads::Network& network, const Trips& trips) {
    std::vector<core::EdgeIndex> edges =
        trips.ends == TripEnds::reachable ? roads::car_edges(network) : roads::largest_car_component(network);
    std::erase_if(edges,
                  [&](core::EdgeIndex edge) { return network.edge(edge).length_m < trips.minimum_edge_m; });
    return edges;
}

SiteRoads::SiteRoads(const roads::Network& network, const Trips& trips, std::span<const SiteKind> kinds)
    : network_(network), lanes_(network), stations_(trip_edges(network, trips)), hospitals_(stations_) {
    if (trips.ends == TripEnds::connected) return;
    const roads::Reach ends(network);
    const auto erase_ends = [&](std::vector<core::EdgeIndex>& edges, roads::Way way) {
        std::erase_if(edges, [&](core::EdgeIndex edge) { return ends.is_end(edge, way); });
    };
    erase_ends(stations_, roads::Way::onward);
    if (std::ranges::none_of(kinds, is_hospital)) erase_ends(stations_, roads::Way::back);
    erase_ends(hospitals_, roads::Way::back);
    if (std::ranges::all_of(kinds, is_hospital)) erase_ends(hospitals_, roads::Way::onward);
}

template <class Fits>
core::EdgeIndex SiteRoads::nearest_where(roads::Point place, const Fits& fits) const {
    std::vector<roads::LanePlace> places;
    lanes_.near(place, reach, places);
    std::erase_if(places, [&](const roads::LanePlace& each) {
        const roads::Lane& lane = network_.lane(each.lane);
        return !lane.allows_cars || network_.edge(lane.edge).internal || !fits(lane.edge);
    });
    const auto nearest = std::ranges::min_element(places, {}, &roads::LanePlace::distance_m);
    return nearest == places.end() ? core::EdgeIndex::none() : network_.lane(nearest->lane).edge;
}

core::EdgeIndex SiteRoads::nearest(SiteKind kind, roads::Point place) const {
    const std::vector<core::EdgeIndex>& edges = is_hospital(kind) ? hospitals_ : stations_;
    return nearest_where(place,
                         [&](core::EdgeIndex edge) { return std::ranges::binary_search(edges, edge); });
}

bool SiteRoads::is_near_road(roads::Point place) const {
    return nearest_where(place, [](core::EdgeIndex) { return true; }).exists();
}

std::vector<core::EdgeIndex> site_edges(const ScenarioConfig& config, const roads::Network& network,
                                        std::vector<core::Problem>& problems) {
    std::vector<SiteKind> kinds;
    for (const EmergencySite& site : config.emergency_sites)
        kinds.push_back(site.kind);
    std::optional<SiteRoads> roads;
    std::vector<core::EdgeIndex> edges;
    for (std::size_t row = 0; row < config.emergency_sites.size(); ++row) {
        const EmergencySite& site = config.emergency_sites[row];
        const std::string key = fmt::format("emergency_site[{}]", row);
        edges.push_back(core::EdgeIndex::none());
        if (!site.longitude) {
            const auto place =
                detail::on_edge(network, site.edge, detail::place_of_key(config, key, "edge"), problems);
            if (place) edges.back() = place->edge;
            continue;
        }
        const roads::Coordinates coordinates{*site.longitude, *site.latitude};
        const std::string where = detail::place_of_key(config, key, "longitude");
        const auto geography = detail::geography_of(network, where, problems);
        if (!geography) continue;
        if (!roads) roads.emplace(network, trips_of(config), kinds);
        edges.back() = roads->nearest(site.kind, geography->point(coordinates));
        if (!edges.back().exists())
            problems.push_back(detail::no_road_near(
                network, coordinates, where,
                fmt::format("no road that trips can use within {:.0f} m", SiteRoads::reach.value)));
    }
    return edges;
}

}  // namespace clearway::scenario
