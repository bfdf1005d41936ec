#include "scenario_import/osm/map_signals.hpp"

#include <algorithm>
#include <cmath>

#include "roads/lane_grid.hpp"

namespace clearway::scenario_import::detail {
namespace {

/// A junction may have its signals at the stop lines, which a wide one keeps from its middle.
constexpr core::Metres signal_reach{50.0};

/// Whether vehicles stop for a signal at the end of a lane, by lane.
std::vector<bool> controlled_lanes(const roads::Network& network) {
    std::vector<bool> controlled(network.lanes().size(), false);
    for (const roads::Signal& signal : network.signals())
        for (const std::vector<roads::SignalLink>& links : signal.links)
            for (const roads::SignalLink& link : links)
                controlled[link.from.value] = true;
    return controlled;
}

double distance_m(const roads::Point& one, const roads::Point& other) {
    return std::hypot(one.x_m - other.x_m, one.y_m - other.y_m);
}

}  // namespace

std::size_t account_for_signals(const std::vector<roads::Coordinates>& signals, const roads::Network& network,
                                LeftOut& left_out) {
    const auto geography = roads::Geography::of(network.location());
    if (!geography) return signals.size();
    const std::vector<bool> controlled = controlled_lanes(network);
    const roads::LaneGrid lanes(network);
    std::vector<roads::LanePlace> near;
    std::size_t known = 0;
    for (const roads::Coordinates& signal : signals) {
        const roads::Point place = geography->point(signal);
        lanes.near(place, signal_reach, near);
        const bool is_known = std::ranges::any_of(near, [&](const roads::LanePlace& found) {
            return controlled[found.lane.value] &&
                   distance_m(network.lane(found.lane).shape.back(), place) <= signal_reach.value;
        });
        if (is_known) {
            ++known;
            continue;
        }
        const auto nearest = std::ranges::min_element(near, {}, &roads::LanePlace::distance_m);
        left_out.add("signals of the map between junctions, such as at crossings for pedestrians",
                     nearest == near.end() ? "" : network.edge(network.lane(nearest->lane).edge).name,
                     LeftOut::all);
    }
    return known;
}

}  // namespace clearway::scenario_import::detail
