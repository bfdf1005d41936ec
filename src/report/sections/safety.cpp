#include "report/safety.hpp"

#include <fmt/format.h>

#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

/// Enough decimals for a mean: two below 10, one below 1000.
NumberStyle style_of(const MaybeEstimate& value, Sign sign = Sign::negative_only) {
    const double size = mean_of(value).value_or(0.0);
    return typeset(size < 10.0 ? 2 : size < 1000.0 ? 1 : 0, sign);
}

DataTable table_of(const ConditionFacts& condition) {
    DataTable table{{"", "per run [95 %]", "against the baseline [95 %]", "per 1,000 vehicle-km"}, {}};
    for (const SafetyRow& row : safety_rows(condition)) {
        const MaybeEstimate& value = row.metric->estimate;
        table.rows.push_back({row.title, estimate(value, style_of(value)),
                              estimate_or_nothing(row.difference(), style_of(value, Sign::always)),
                              row.per_1000_km ? number(*row.per_1000_km, typeset(2)) : std::string()});
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
            if (condition.complete_runs == 0) continue;
            writer.open_fold(condition_label(condition));
            writer.table({fmt::format("safety-{}-{}", scenario.name, condition.title),
                          fmt::format("{}, {}: safety, comfort and flow", scenario.name, condition.label()),
                          table_of(condition)});
            writer.close_fold();
        }
    }
}

}  // namespace clearway::report::detail
