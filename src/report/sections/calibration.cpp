#include <fmt/format.h>

#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {

void calibration_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>Flows of the baseline, without EVs and while demand departs, compared with flows counted on the "
        "road. GEH = \u221a(2 (m \u2212 c)\u00b2 / (m + c)) of hourly flows; below 5 a flow counts as "
        "matched, and the usual criterion requires this at 85 % of the places.</p>\n");
    for (const ScenarioFacts& scenario : study.scenarios) {
        if (scenario.flows.empty()) continue;
        DataTable table{{"Place", "counted, veh/h", "modelled, veh/h", "GEH"}, {}};
        std::size_t met = 0;
        for (const FlowFacts& flow : scenario.flows) {
            if (flow.geh && *flow.geh < analysis::geh_limit) ++met;
            table.rows.push_back({scenario.place_name(flow.edge), number(flow.counted_per_hour, typeset(0)),
                                  number_or_dash(flow.modelled_per_hour, typeset(0)),
                                  number_or_dash(flow.geh, typeset(1))});
        }
        writer.heading(scenario.name);
        writer.markup(fmt::format("<p>{} of {} places have a GEH below {}.</p>\n", met, scenario.flows.size(),
                                  analysis::geh_limit));
        writer.table({"flows-" + scenario.name, scenario.name + ": flows against counts", std::move(table)});
    }
}

}  // namespace clearway::report::detail
