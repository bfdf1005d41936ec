#include "scenario/road_limits.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/number.hpp"
#include "core/units.hpp"
#include "core/xml_stream.hpp"
#include "roads/permissions.hpp"

namespace clearway::scenario {
namespace {

constexpr double usual_limit_mps = 13.89;  // netconvert's for an edge that states none

/// The limit that the scenario leaves of an edge's own.
double changed(const ScenarioConfig& config, const std::string& edge, double limit_mps) {
    if (config.limits.road_kmh > 0.0)
        limit_mps = std::min(limit_mps, core::from_kmh(config.limits.road_kmh).value);
    for (const Stretch& stretch : config.road.stretches)
        if (core::contains(stretch.edges, edge)) return limit_mps * stretch.speed_factor;
    return limit_mps * config.road.speed_factor;
}

/// Reads plain XML, nodes first.
class PlainRoads : public core::XmlHandler {
  public:
    explicit PlainRoads(const ScenarioConfig& config) : config_(config) {}

    void start(std::string_view element, const core::XmlAttributes& attributes, unsigned long) override {
        const auto text = [&](const char* name) { return std::string(attributes.find(name).value_or("")); };
        const auto number = [&](const char* name, double otherwise) {
            return core::number_from(text(name)).value_or(otherwise);
        };
        if (element == "node") places_[text("id")] = {number("x", 0.0), number("y", 0.0)};
        if (element == "edge") {
            const auto [from_x_m, from_y_m] = places_[text("from")];
            const auto [to_x_m, to_y_m] = places_[text("to")];
            edge_ = {.id = text("id"),
                     .length_m = std::hypot(to_x_m - from_x_m, to_y_m - from_y_m),
                     .lane_count = number("numLanes", 1.0),
                     .usual = {number("speed", usual_limit_mps), roads::permissions_of(attributes).cars}};
        }
        if (element == "lane") {
            const bool has_own = attributes.find("allow") || attributes.find("disallow");
            edge_.lanes[text("index")] = {
                number("speed", edge_.usual.limit_mps),
                has_own ? roads::permissions_of(attributes).cars : edge_.usual.allows_cars};
        }
    }
    void end(std::string_view element) override {
        if (element == "edge") limits_.add(changed(config_, edge_.id, edge_.limit_mps()), edge_.length_m);
    }
    const roads::Limits& limits() const { return limits_; }

  private:
    struct PlainLane {
        double limit_mps = 0.0;
        bool allows_cars = false;
    };
    struct PlainEdge {
        std::string id = {};
        double length_m = 0.0;
        double lane_count = 1.0;
        PlainLane usual = {};                         ///< Lanes of which the file says nothing more.
        std::map<std::string, PlainLane> lanes = {};  ///< The others, by their number.

        /// As roads::limit_mps.
        double limit_mps() const {
            double fastest_mps = 0.0;
            const auto include = [&](const PlainLane& lane) {
                if (lane.allows_cars) fastest_mps = std::max(fastest_mps, lane.limit_mps);
            };
            if (static_cast<double>(lanes.size()) < lane_count) include(usual);
            for (const auto& [number, lane] : lanes)
                include(lane);
            return fastest_mps;
        }
    };

    const ScenarioConfig& config_;
    std::map<std::string, std::pair<double, double>> places_;
    PlainEdge edge_;
    roads::Limits limits_;
};

}  // namespace

roads::Limits road_limits(const ScenarioConfig& config) try {
    if (config.network.plain()) {
        PlainRoads roads(config);
        core::stream_xml(resolve(config, config.network.nodes), roads);
        core::stream_xml(resolve(config, config.network.edges), roads);
        return roads.limits();
    }
    const roads::Network network = roads::Network::read(resolve(config, config.network.file));
    roads::Limits limits;
    for (const roads::Edge& edge : network.edges())
        limits.add(changed(config, edge.id, roads::limit_mps(network, edge)), edge.length_m);
    return limits;
} catch (const core::Error&) {
    return {};
}

}  // namespace clearway::scenario
