#include "study/detail/road_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "core/json.hpp"
#include "roads/closure.hpp"

namespace clearway::study::detail {
namespace {

double tenths(double value) {
    return std::round(10.0 * value) / 10.0;
}

/// The middle one of the lanes that an emergency vehicle may use; nothing if there is none.
std::optional<core::LaneIndex> middle_lane(const roads::Network& network, const roads::Edge& edge) {
    std::vector<core::LaneIndex> open;
    for (std::uint32_t number = 0; number < edge.lane_count; ++number) {
        const core::LaneIndex lane{edge.first_lane + number};
        if (network.lane(lane).allows_emergency || network.lane(lane).allows_cars) open.push_back(lane);
    }
    if (open.empty()) return std::nullopt;
    return open[open.size() / 2];
}

/// The ways out of an edge for emergency vehicles, and whether a signal controls one of them.
struct Ways {
    std::set<core::EdgeIndex> to;
    bool signal = false;
};

Ways ways_from(const roads::Network& network, const roads::Edge& edge) {
    Ways ways;
    for (std::uint32_t number = 0; number < edge.lane_count; ++number) {
        for (const roads::Connection& connection :
             network.connections_from(core::LaneIndex{edge.first_lane + number})) {
            if (!connection.allows_emergency && !connection.allows_cars) continue;
            ways.to.insert(network.lane(connection.to).edge);
            ways.signal = ways.signal || connection.signal.exists();
        }
    }
    return ways;
}

core::Json signals_json(const roads::Network& network) {
    core::Json signals = core::Json::array();
    for (const roads::Signal& signal : network.signals()) {
        double x = 0.0;
        double y = 0.0;
        double count = 0.0;
        for (const auto& link : signal.links) {
            for (const roads::SignalLink& way : link) {
                const roads::Point end = network.lane(way.from).shape.back();
                x += end.x_m;
                y += end.y_m;
                count += 1.0;
            }
        }
        if (count == 0.0) continue;
        signals.push_back({{"id", signal.id}, {"x_m", tenths(x / count)}, {"y_m", tenths(y / count)}});
    }
    return signals;
}

/// Where no station is known, emergency vehicles start from hospitals, in the demand as well.
core::Json stations_json(const roads::Network& network, const scenario::ScenarioConfig& config) {
    const auto is_station = [](const scenario::EmergencySite& site) {
        return site.kind != scenario::SiteKind::hospital;
    };
    const bool has_station = std::ranges::any_of(config.emergency_sites, is_station);
    std::vector<core::Problem> problems;
    const std::vector<core::EdgeIndex> edges = scenario::site_edges(config, network, problems);
    if (!problems.empty()) throw core::InputError(std::move(problems));
    core::Json stations = core::Json::array();
    for (std::size_t row = 0; row < edges.size(); ++row) {
        const scenario::EmergencySite& site = config.emergency_sites[row];
        if (has_station && !is_station(site)) continue;
        stations.push_back(
            {{"edge", network.edge(edges[row]).id}, {"kind", core::name(site.kind)}, {"name", site.name}});
    }
    return stations;
}

core::Json incidents_json(const roads::Network& network, const scenario::ScenarioConfig& config) {
    core::Json incidents = core::Json::array();
    for (const scenario::PlacedIncident& placed : scenario::place_incidents(config, network)) {
        const traffic::Incident& incident = placed.closed;
        core::Json row = {{"edge", network.edge(incident.edge).id},
                          {"from_s", tenths(incident.from.value)},
                          {"to_s", tenths(incident.to.value)},
                          {"closed_to_emergency", roads::closes_to_emergency(network, incident)}};
        if (incident.known_after) row["known_after_s"] = tenths(incident.known_after->value);
        if (config.time.events_spread_s) row["spread_s"] = *config.time.events_spread_s;
        incidents.push_back(std::move(row));
    }
    return incidents;
}

core::Json calls_json(const roads::Network& network, const scenario::ScenarioConfig& config) {
    const scenario::Calls placed =
        scenario::place_calls(config, network, scenario::place_incidents(config, network));
    core::Json calls = core::Json::array();
    for (const scenario::PlacedCall& call : placed.calls)
        calls.push_back(
            {{"edge", network.edge(call.edge).id}, {"at_s", tenths(call.at.value)}, {"units", call.units}});
    return calls;
}

}  // namespace

std::string road_map_json(const roads::Network& network, const scenario::ScenarioConfig& config) {
    std::vector<std::optional<std::size_t>> place(network.edges().size());
    std::size_t count = 0;
    for (std::size_t index = 0; index < place.size(); ++index) {
        const roads::Edge& edge = network.edges()[index];
        if (!edge.internal && middle_lane(network, edge)) place[index] = count++;
    }
    core::Json edges = core::Json::array();
    for (std::size_t index = 0; index < place.size(); ++index) {
        if (!place[index]) continue;
        const roads::Edge& edge = network.edges()[index];
        const roads::Lane& lane = network.lane(*middle_lane(network, edge));
        const Ways ways = ways_from(network, edge);
        core::Json to = core::Json::array();
        for (const core::EdgeIndex next : ways.to) {
            if (place[next.value]) to.push_back(*place[next.value]);
        }
        core::Json shape = core::Json::array();
        for (const roads::Point& point : lane.shape) {
            shape.push_back(tenths(point.x_m));
            shape.push_back(tenths(point.y_m));
        }
        edges.push_back({{"id", edge.id},
                         {"to", std::move(to)},
                         {"signal", ways.signal},
                         {"length_m", tenths(edge.length_m)},
                         {"limit_mps", std::round(100.0 * lane.speed_limit_mps) / 100.0},
                         {"shape_m", std::move(shape)}});
    }
    const core::Json map = {{"edges", std::move(edges)},
                            {"signals", signals_json(network)},
                            {"stations", stations_json(network, config)},
                            {"incidents", incidents_json(network, config)},
                            {"calls", calls_json(network, config)}};
    return map.dump(-1, ' ', false, core::Json::error_handler_t::replace) + "\n";
}

}  // namespace clearway::study::detail
