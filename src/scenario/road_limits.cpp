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

namespace clearway::scenario {
namespace {

constexpr double usual_limit_mps = 13.89;  // netconvert's for an edge that states none

/// The limit that the scenario leaves of an edge's own.
double changed(const ScenarioConfig& config, const std::string& edge, double limit_mps) {
    if (config.limits.road_kmh > 0.0)
        limit_mps = std::min(limit_mps, core::from_kmh(config.limits.road_kmh).value);
    for (const Stretch& stretch : config.road.stretches)
        if (std::ranges::find(stretch.edges, edge) != stretch.edges.end())
            return limit_mps * stretch.speed_factor;
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
        if (element != "edge") return;
        const auto [from_x_m, from_y_m] = places_[text("from")];
        const auto [to_x_m, to_y_m] = places_[text("to")];
        limits_.add(changed(config_, text("id"), number("speed", usual_limit_mps)),
                    std::hypot(to_x_m - from_x_m, to_y_m - from_y_m));
    }
    void end(std::string_view) override {}
    const roads::Limits& limits() const { return limits_; }

  private:
    const ScenarioConfig& config_;
    std::map<std::string, std::pair<double, double>> places_;
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
