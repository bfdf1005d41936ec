#include "scenario_import/osm/map_signals.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "roads/lane_grid.hpp"

namespace clearway::scenario_import::detail {
namespace {

/// A junction may have its signals at the stop lines, which a wide one keeps from its middle.
constexpr double signal_reach_m = 50.0;
constexpr core::Metres street_reach{30.0};

std::vector<roads::Point> stop_lines(const roads::Network& network) {
    std::vector<roads::Point> places;
    for (const roads::Signal& signal : network.signals())
        for (const std::vector<roads::SignalLink>& links : signal.links)
            for (const roads::SignalLink& link : links)
                places.push_back(network.lane(link.from).shape.back());
    return places;
}

/// Of the nearest road; empty where none is near, or where it has no name.
std::string street_at(const roads::Network& network, const roads::LaneGrid& lanes,
                      const roads::Point& place) {
    std::vector<roads::LanePlace> near;
    lanes.near(place, street_reach, near);
    const auto nearest = std::ranges::min_element(near, {}, &roads::LanePlace::distance_m);
    return nearest == near.end() ? "" : network.edge(network.lane(nearest->lane).edge).name;
}

}  // namespace

void account_for_signals(const std::vector<roads::Coordinates>& signals, const roads::Network& network,
                         LeftOut& left_out) {
    const auto geography = roads::Geography::of(network.location());
    if (!geography) return;
    const std::vector<roads::Point> known = stop_lines(network);
    const roads::LaneGrid lanes(network);
    for (const roads::Coordinates& signal : signals) {
        const roads::Point place = geography->point(signal);
        const bool is_known = std::ranges::any_of(known, [&](const roads::Point& line) {
            return std::hypot(line.x_m - place.x_m, line.y_m - place.y_m) <= signal_reach_m;
        });
        if (!is_known)
            left_out.add(
                "signals of the map between junctions, such as at crossings for pedestrians: netconvert "
                "builds "
                "none there",
                street_at(network, lanes, place), LeftOut::all);
    }
}

}  // namespace clearway::scenario_import::detail
