#include <map>

#include <fmt/format.h>

#include "report/detail/figures.hpp"
#include "report/published.hpp"
#include "report/sections/sections.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

/// All edges; those with three or more lanes for cars say how many.
DataTable edges_of(const ScenarioFacts& scenario) {
    DataTable table{{"edge", "street", "length, m", "limit, km/h", "ends at a signal", "lanes for cars"},
                    {},
                    DataTable::Cells::words};
    std::map<std::string, WideEdge> wide;
    for (const WideEdge& edge : scenario.wide_edges.value_or(std::vector<WideEdge>{}))
        wide.emplace(edge.edge, edge);
    const auto lanes_of = [&](const std::string& edge) -> std::string {
        const auto found = wide.find(edge);
        if (found != wide.end()) return std::to_string(found->second.car_lanes);
        return scenario.wide_edges ? "1 or 2" : "";
    };
    constexpr double kmh_per_mps = 3.6;
    for (const MapEdge& edge : scenario.roads.value_or(RoadMap{}).edges) {
        const auto street = scenario.streets.find(edge.id);
        table.rows.push_back({edge.id, street == scenario.streets.end() ? "" : street->second,
                              number(edge.length_m, typeset(1)),
                              number(kmh_per_mps * edge.limit_mps, typeset(0)), edge.signal ? "yes" : "no",
                              lanes_of(edge.id)});
        wide.erase(edge.id);
    }
    for (const auto& [id, edge] : wide)  // of folders that list no others
        table.rows.push_back({id, edge.street, "", "", "", std::to_string(edge.car_lanes)});
    return table;
}

Figure network_figure(const ScenarioFacts& scenario, const Looks& /*looks*/) {
    if (scenario.network_svg.empty()) return {};
    std::string note = wide_edges_sentence(scenario);
    if (!note.empty() && !scenario.attribution.empty()) note += ' ';
    const std::optional<PublishedTable> published = published_table(scenario.name);
    const std::string title =
        published ? fmt::format("{} ({} of the dissertation)", scenario.name, published->figure)
                  : scenario.name;
    return {"network-" + scenario.name, title, scenario.network_svg, note + scenario.attribution,
            edges_of(scenario)};
}

}  // namespace

void networks_section(const StudyFacts& study, Writer& writer) {
    writer.figures(figures_of(study, network_figure));
}

}  // namespace clearway::report::detail
