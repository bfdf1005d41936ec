#include <fmt/format.h>

#include "report/detail/figures.hpp"
#include "report/published.hpp"
#include "report/sections/sections.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

Figure network_figure(const ScenarioFacts& scenario) {
    if (scenario.network_svg.empty()) return {};
    DataTable wide{{"edge", "street", "lanes for cars"}, {}, DataTable::Cells::words};
    for (const WideEdge& edge : scenario.wide_edges.value_or(std::vector<WideEdge>{})) {
        wide.rows.push_back({edge.edge, edge.street, std::to_string(edge.car_lanes)});
    }
    std::string note = wide_edges_sentence(scenario);
    if (!note.empty() && !scenario.attribution.empty()) note += ' ';
    const std::optional<PublishedTable> published = published_table(scenario.name);
    const std::string title =
        published ? fmt::format("{} ({} of the dissertation)", scenario.name, published->figure)
                  : scenario.name;
    return {"network-" + scenario.name, title, scenario.network_svg, note + scenario.attribution,
            std::move(wide)};
}

}  // namespace

void networks_section(const StudyFacts& study, Writer& writer) {
    writer.figures(figures_of(study, network_figure));
}

}  // namespace clearway::report::detail
