#include <algorithm>

#include <fmt/format.h>

#include "report/detail/figures.hpp"
#include "report/planned_text.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {

void plan_section(const StudyFacts& study, Writer& writer) {
    DataTable table{
        {"Comparison", "difference, s", "pairs", "p", "p, Holm", "finding"}, {}, DataTable::Cells::words};
    for (const analysis::PlannedFinding& finding : study.planned) {
        table.rows.push_back({fmt::format("{}: {} ({})", finding.scenario, finding.comparison.name,
                                          pair_words(study, finding, Script::typeset)),
                              estimate(finding.difference, typeset(2, Sign::ends_too)),
                              grouped(finding.pairs), p_words(finding.p, Script::typeset),
                              p_words(finding.holm_p, Script::typeset),
                              finding_words(finding, Script::typeset)});
    }
    writer.markup(fmt::format("<p>{} Everything else on this page is exploratory.</p>\n",
                              escaped(plan_sentence(study))));
    const auto measure = std::ranges::find(measures(), study.plan->metric, &MeasureInfo::field);
    writer.table(
        {"plan",
         "Findings of the plan: " +
             (measure == measures().end() ? study.plan->metric : labelled(measure->measure, "difference")),
         std::move(table)});
}

}  // namespace clearway::report::detail
