#include "scenario/detail/road_place.hpp"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

#include "core/number.hpp"
#include "roads/lane_grid.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario::detail {

std::string place_of_key(const ScenarioConfig& config, const std::string& row, const std::string& key) {
    const auto found = config.origins.find(row + "." + key);
    return found == config.origins.end() ? config.where(row) + "." + key : found->second;
}

std::string place_of_row(const ScenarioConfig& config, const std::string& row, bool has_place) {
    const std::string edge = row + ".edge";
    return config.where(!has_place && config.origins.contains(edge) ? edge : row);
}

std::optional<RoadPlace> on_edge(const roads::Network& network, const std::string& id,
                                 const std::string& where, std::vector<core::Problem>& problems) {
    const auto found = network.find_edge(id);
    if (found && !network.edge(*found).internal)
        return RoadPlace{*found, network.edge(*found).length_m / 2.0F};
    std::vector<std::string> known;
    for (const roads::Edge& edge : network.edges())
        if (!edge.internal) known.push_back(edge.id);
    const bool has_projection = roads::Geography::of(network.location()).has_value();
    problems.push_back(
        {where, fmt::format("the network has no edge \"{}\"", id), "id of an edge outside junctions",
         core::did_you_mean(id, known, has_projection ? "give longitude and latitude instead" : "")});
    return std::nullopt;
}

std::optional<roads::Geography> geography_of(const roads::Network& network, const std::string& where,
                                             std::vector<core::Problem>& problems) {
    auto geography = roads::Geography::of(network.location());
    if (!geography)
        problems.push_back({where, "the network has no projection that Clearway knows", "networks from a map",
                            "give edge instead"});
    return geography;
}

core::Problem no_road_near(const roads::Network& network, roads::Coordinates place, const std::string& where,
                           const std::string& missing) {
    const auto geography = roads::Geography::of(network.location());
    assert(geography);
    const roads::Location& box = network.location();
    const auto low = geography->coordinates(box.x_minimum_m, box.y_minimum_m);
    const auto high = geography->coordinates(box.x_maximum_m, box.y_maximum_m);
    return {where, fmt::format("{} of {}, {}", missing, place.longitude_deg, place.latitude_deg),
            fmt::format("longitude {:.4f} to {:.4f}, latitude {:.4f} to {:.4f}", low.longitude_deg,
                        high.longitude_deg, low.latitude_deg, high.latitude_deg),
            "mind the order: longitude is east, latitude is north"};
}

std::optional<RoadPlace> at_coordinates(const roads::Network& network, roads::Coordinates place,
                                        const std::string& where, std::vector<core::Problem>& problems) {
    const auto geography = geography_of(network, where, problems);
    if (!geography) return std::nullopt;
    constexpr core::Metres reach{100.0};
    std::vector<roads::LanePlace> places;
    roads::LaneGrid(network).near(geography->point(place), reach, places);
    std::erase_if(places, [&](const roads::LanePlace& each) {
        const roads::Lane& lane = network.lane(each.lane);
        return !lane.allows_cars || network.edge(lane.edge).internal;
    });
    const auto nearest = std::ranges::min_element(places, {}, &roads::LanePlace::distance_m);
    if (nearest != places.end()) return RoadPlace{network.lane(nearest->lane).edge, nearest->position_m};
    problems.push_back(no_road_near(network, place, where,
                                    fmt::format("no road open to cars within {:.0f} m", reach.value)));
    return std::nullopt;
}

void move_to(const roads::Network& network, double position_m, const std::string& where, RoadPlace& place,
             std::vector<core::Problem>& problems) {
    constexpr double rounding_m = 0.05;  // lengths are shown with two decimals
    const roads::Edge& edge = network.edge(place.edge);
    if (position_m > edge.length_m + rounding_m)
        problems.push_back({where, fmt::format("{} is beyond the end of edge \"{}\"", position_m, edge.id),
                            fmt::format("0 to {:.2f} m", edge.length_m), "or leave it out for the middle"});
    place.position_m = std::min(static_cast<float>(position_m), edge.length_m);
}

}  // namespace clearway::scenario::detail
