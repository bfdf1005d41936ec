#include <fmt/format.h>

#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

/// Enough decimals for a mean: two below 10, one below 1000.
NumberStyle style_of(const Estimate& value, Sign sign = Sign::negative_only) {
    const double size = value.mean.value_or(0.0);
    return {size < 10.0 ? 2 : size < 1000.0 ? 1 : 0, Script::typeset, sign};
}

DataTable table_of(const ConditionFacts& condition) {
    DataTable table{{"", "per run [95 %]", "against the baseline [95 %]", "per 1,000 vehicle-km"}, {}};
    for (const SafetyFacts& row : condition.safety) {
        const NumberStyle with_sign = style_of(row.value, Sign::always);
        table.rows.push_back(
            {row.title, estimate(row.value, style_of(row.value)),
             row.difference.mean ? estimate(row.difference, with_sign) : std::string(),
             row.per_1000_km ? number(*row.per_1000_km, {2, Script::typeset}) : std::string()});
    }
    return table;
}

}  // namespace

void safety_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>What happens between vehicles, and how the traffic of the others flows. Time to collision and "
        "the deceleration to avoid a crash are those of vehicles that follow each other on one lane within "
        "100 m of an EV. Like red passages, braking, jerk and queues, they are counted from a minute before "
        "the first EV. Queues and passages of stop lines are measured while demand departs.</p>\n");
    for (const ScenarioFacts& scenario : study.scenarios) {
        writer.heading(scenario.name);
        for (const ConditionFacts& condition : scenario.conditions) {
            if (condition.safety.empty()) continue;
            writer.open_fold(condition_label(condition));
            writer.table(
                {fmt::format("safety-{}-{}", scenario.name, condition.name), "", table_of(condition)});
            writer.close_fold();
        }
    }
}

}  // namespace clearway::report::detail
