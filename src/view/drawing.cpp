#include "view/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/json.hpp"
#include "view/frame.hpp"

namespace clearway::view {
namespace {

using core::Json;

std::int32_t quanta(double metres) {
    return static_cast<std::int32_t>(std::lround(metres / quantum_m));
}

/// `road`, `junction` (a way across it) or `walk` (no car may use it).
const char* kind_of(const roads::Network& network, const roads::Lane& lane) {
    const roads::Edge& edge = network.edge(lane.edge);
    if (edge.crossing || edge.walking_area || !lane.allows_cars) return "walk";
    return edge.internal ? "junction" : "road";
}

Json shape_of(const roads::Lane& lane, const Origin& origin) {
    Json shape = Json::array();
    std::int32_t x = 0;
    std::int32_t y = 0;
    for (const roads::Point& point : lane.shape) {
        shape.push_back(origin.x(point.x_m) - x);
        shape.push_back(origin.y(point.y_m) - y);
        x = origin.x(point.x_m);
        y = origin.y(point.y_m);
    }
    return shape;
}

Json stop_lines_of(const roads::Network& network, const roads::Signal& signal, std::size_t link,
                   const Origin& origin) {
    Json lines = Json::array();
    for (const roads::SignalLink& way : signal.links[link]) {
        const roads::Lane& lane = network.lane(way.from);
        const roads::Point end = lane.shape.back();
        const double degrees =
            network.heading_at(way.from, core::Metres(lane.length_m)) * 180.0 / std::numbers::pi;
        Json line = {origin.x(end.x_m), origin.y(end.y_m), std::lround(degrees), quanta(lane.width_m)};
        if (!core::contains(lines, line)) lines.push_back(std::move(line));
    }
    return lines;
}

}  // namespace

std::int32_t Origin::x(double metres) const {
    return quanta(metres - x_m);
}
std::int32_t Origin::y(double metres) const {
    return quanta(metres - y_m);
}

Origin origin_of(const roads::Network& network) {
    constexpr double far = std::numeric_limits<double>::max();
    Origin origin{far, far};
    for (const roads::Lane& lane : network.lanes()) {
        for (const roads::Point& point : lane.shape) {
            origin.x_m = std::min(origin.x_m, std::floor(static_cast<double>(point.x_m)));
            origin.y_m = std::min(origin.y_m, std::floor(static_cast<double>(point.y_m)));
        }
    }
    return network.lanes().empty() ? Origin() : origin;
}

std::string drawing_of(const roads::Network& network) {
    const Origin origin = origin_of(network);
    std::int32_t width = 0;
    std::int32_t height = 0;
    Json lanes = Json::array();
    for (const roads::Lane& lane : network.lanes()) {
        for (const roads::Point& point : lane.shape) {
            width = std::max(width, origin.x(point.x_m));
            height = std::max(height, origin.y(point.y_m));
        }
        lanes.push_back({{"kind", kind_of(network, lane)},
                         {"width", quanta(lane.width_m)},
                         {"shape", shape_of(lane, origin)}});
    }
    Json edges = Json::array();
    for (const roads::Edge& edge : network.edges()) {
        edges.push_back(edge.first_lane);
        edges.push_back(edge.lane_count);
    }
    Json signals = Json::array();
    for (const roads::Signal& signal : network.signals()) {
        Json links = Json::array();
        for (std::size_t link = 0; link < signal.links.size(); ++link)
            links.push_back(stop_lines_of(network, signal, link, origin));
        signals.push_back({{"id", signal.id}, {"links", std::move(links)}});
    }
    const Json drawing = {{"quantum_m", quantum_m},    {"origin_m", {origin.x_m, origin.y_m}},
                          {"size", {width, height}},   {"lanes", std::move(lanes)},
                          {"edges", std::move(edges)}, {"signals", std::move(signals)}};
    return drawing.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace clearway::view
