#include "report/detail/side_files.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "metrics/counts.hpp"

namespace clearway::report::detail {
namespace {

using nlohmann::json;

/// What `from` makes of a JSON file; nothing if the file is missing.
template <class From>
auto read_json(const std::filesystem::path& file, const char* wanted, const From& from)
    -> std::optional<decltype(from(json()))> {
    if (!std::filesystem::exists(file)) return std::nullopt;
    try {
        return from(json::parse(core::read_file(file)));
    } catch (const json::exception& error) {
        throw core::InputError(core::Problem{file.string(), error.what(), wanted,
                                             "Remove the file, or create the run folder again"});
    }
}

/// Texts by name; none if the file is missing.
core::Settings texts_in(const std::filesystem::path& file, const char* wanted) {
    return read_json(file, wanted, [](const json& object) { return object.get<core::Settings>(); })
        .value_or(core::Settings());
}

std::vector<WideEdge> wide_edges_from(const json& rows) {
    std::vector<WideEdge> edges;
    for (const json& row : rows)
        edges.push_back({row.at("edge").get<std::string>(), row.at("street").get<std::string>(),
                         row.at("car_lanes").get<int>()});
    return edges;
}

MapEdge edge_from(const json& row, std::size_t edges) {
    MapEdge edge;
    row.at("id").get_to(edge.id);
    row.at("to").get_to(edge.to);
    row.at("signal").get_to(edge.signal);
    row.at("length_m").get_to(edge.length_m);
    row.at("limit_mps").get_to(edge.limit_mps);
    const auto numbers = row.at("shape_m").get<std::vector<double>>();
    for (std::size_t at = 0; at + 1 < numbers.size(); at += 2)
        edge.shape.emplace_back(numbers[at], numbers[at + 1]);
    for (const std::size_t next : edge.to) {
        if (next >= edges)
            throw json::other_error::create(501, "an edge leads to one that is not listed", &row);
    }
    return edge;
}

MapIncident incident_from(const json& row) {
    MapIncident incident{row.at("edge").get<std::string>(), row.at("from_s").get<double>(),
                         row.at("to_s").get<double>()};
    if (row.contains("known_after_s")) incident.known_after_s = row["known_after_s"].get<double>();
    incident.spread_s = row.value("spread_s", 0.0);
    incident.is_closed = row.value("closed_to_emergency", false);
    return incident;
}

RoadMap roads_from(const json& object) {
    RoadMap map;
    for (const json& row : object.at("edges"))
        map.edges.push_back(edge_from(row, object.at("edges").size()));
    for (const json& row : object.at("signals"))
        map.signals.push_back(
            {row.at("id").get<std::string>(), {row.at("x_m").get<double>(), row.at("y_m").get<double>()}});
    for (const json& row : object.at("stations"))
        map.stations.push_back({row.at("edge").get<std::string>(), row.at("kind").get<std::string>(),
                                row.at("name").get<std::string>()});
    for (const json& row : object.value("incidents", json::array()))
        map.incidents.push_back(incident_from(row));
    for (const json& row : object.value("calls", json::array()))
        map.calls.push_back({row.at("edge").get<std::string>(), row.at("at_s").get<double>(),
                             row.at("units").get<std::uint64_t>()});
    return map;
}

}  // namespace

core::Settings titles_in(const std::filesystem::path& file) {
    return texts_in(file, "an object of names and their titles");
}

core::Settings controls_in(const std::filesystem::path& file) {
    return texts_in(file, "an object of controls and their conditions");
}

std::optional<std::vector<WideEdge>> wide_edges_in(const std::filesystem::path& file) {
    return read_json(file, "a list of objects with edge, street and car_lanes", wide_edges_from);
}

std::map<std::string, std::string> streets_in(const std::filesystem::path& file) {
    return texts_in(file, "an object of edges and their street names");
}

std::string outlook_in(const std::filesystem::path& file) {
    const auto sentence = [](const json& object) {
        return object.at("signals") > 0 ? object.at("sentence").get<std::string>() : "";
    };
    return read_json(file, "an object with signals and a sentence", sentence).value_or("");
}

std::optional<RoadMap> roads_in(const std::filesystem::path& file) {
    return read_json(file, "an object with edges, signals and stations", roads_from);
}

std::vector<FlowFacts> flows_in(const std::filesystem::path& file, const results::Results& results,
                                const ScenarioFacts& scenario) {
    if (!std::filesystem::exists(file)) return {};
    double runs = 0.0;
    std::map<std::string, double> sums;
    for (const results::RunRecord& run : results.runs) {
        if (run.key.scenario != scenario.name || run.key.condition != scenario.conditions.front().name())
            continue;
        ++runs;
        for (const metrics::ApproachRow& row : run.traffic.approaches)
            sums[row.edge] += row.flow_per_hour;
    }
    std::vector<FlowFacts> flows;
    for (const metrics::EdgeCount& count : metrics::read_counts(file)) {
        FlowFacts& flow = flows.emplace_back();
        flow.edge = count.edge;
        flow.counted_per_hour = count.vehicles_per_hour;
        if (runs == 0.0) continue;
        flow.modelled_per_hour = sums[count.edge] / runs;
        flow.geh = analysis::geh(*flow.modelled_per_hour, count.vehicles_per_hour);
    }
    return flows;
}

}  // namespace clearway::report::detail
