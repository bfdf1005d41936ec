#include "actuation/detail/ways.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/units.hpp"

namespace clearway::actuation::detail {
namespace {

constexpr double sampling_m = 1.0;
/// Two vehicles 2 m wide with half a metre to either side.
constexpr double touching_m = 3.0;

struct Sample {
    roads::Point point;
    double at_m;
};

std::vector<Sample> samples_of(const roads::Network& network, const roads::SignalLink& way) {
    std::vector<Sample> samples;
    double passed_m = 0.0;
    for (const core::LaneIndex lane : lanes_of_way(network, way)) {
        const double length_m = network.lane(lane).length_m;
        samples.reserve(samples.size() + static_cast<std::size_t>(length_m / sampling_m) + 2);
        for (double at_m = 0.0; at_m < length_m + sampling_m; at_m += sampling_m) {
            const double on_lane_m = std::min(at_m, length_m);
            samples.push_back({network.point_at(lane, core::Metres(on_lane_m)), passed_m + on_lane_m});
        }
        passed_m += length_m;
    }
    return samples;
}

bool touch(const roads::Point& left, const roads::Point& right) {
    return std::hypot(left.x_m - right.x_m, left.y_m - right.y_m) < touching_m;
}

}  // namespace

std::vector<core::LaneIndex> lanes_of_way(const roads::Network& network, const roads::SignalLink& way) {
    if (!way.via.exists()) return {way.to};
    std::vector<core::LaneIndex> lanes;
    core::LaneIndex lane = way.via;
    while (lane.exists()) {
        lanes.push_back(lane);
        assert(lanes.size() < 100 && "a way across a junction does not lead in a circle");
        const auto onward = network.connections_from(lane);
        lane = onward.empty() ? core::LaneIndex::none() : onward.front().via;
    }
    return lanes;
}

SharedArea shared_area(const roads::Network& network, const roads::SignalLink& first,
                       const roads::SignalLink& second) {
    const std::vector<Sample> on_first = samples_of(network, first);
    const std::vector<Sample> on_second = samples_of(network, second);
    bool found = false;
    SharedArea area{length_of_way(network, first), 0.0};
    for (const Sample& left : on_first) {
        for (const Sample& right : on_second) {
            if (!touch(left.point, right.point)) continue;
            area.last_on_first_m = left.at_m;
            area.first_on_second_m = found ? std::min(area.first_on_second_m, right.at_m) : right.at_m;
            found = true;
        }
    }
    return area;
}

bool turns(const roads::Network& network, const roads::SignalLink& way) {
    const core::Metres end(network.lane(way.from).length_m);
    const double bend_rad = network.heading_at(way.to, core::Metres(0.0)) - network.heading_at(way.from, end);
    return std::abs(std::remainder(bend_rad, 2.0 * std::numbers::pi)) > std::numbers::pi / 4.0;
}

double length_of_way(const roads::Network& network, const roads::SignalLink& way) {
    double length_m = 0.0;
    for (const core::LaneIndex lane : lanes_of_way(network, way))
        length_m += network.lane(lane).length_m;
    return length_m;
}

}  // namespace clearway::actuation::detail
