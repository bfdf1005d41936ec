#include <fmt/format.h>

#include "report/detail/figures.hpp"
#include "report/planned_text.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {

void plan_section(const StudyFacts& study, Writer& writer) {
    const auto p_text = [](const std::optional<double>& p) { return number_or_dash(p, typeset(4)); };
    DataTable table{
        {"Comparison", "difference, s", "pairs", "p", "p, Holm", "finding"}, {}, DataTable::Cells::words};
    for (const analysis::PlannedFinding& finding : study.planned) {
        table.rows.push_back({fmt::format("{}: {} ({} \u2212 {})", finding.scenario, finding.comparison.name,
                                          finding.comparison.condition, finding.comparison.against),
                              estimate(finding.difference, typeset(2, Sign::ends_too)),
                              grouped(finding.pairs), p_text(finding.p), p_text(finding.holm_p),
                              finding_words(finding, Script::typeset)});
    }
    writer.markup(fmt::format("<p>{} Everything else on this page is exploratory.</p>\n",
                              escaped(plan_sentence(study))));
    writer.table({"plan", "Findings of the plan", std::move(table)});
}

}  // namespace clearway::report::detail
