#include "scenario_import/detail/survey.hpp"

#include <algorithm>
#include <cmath>

#include "roads/reach.hpp"

namespace clearway::scenario_import::detail {

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

}  // namespace clearway::scenario_import::detail
