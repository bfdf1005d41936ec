#include <algorithm>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

std::string replications_needed(const ConditionFacts& condition) {
    if (!condition.precision) return missing(Script::typeset);
    const auto& unlocked = condition.precision->needed_unlocked;
    return replications_words(condition.precision->needed) +
           (unlocked ? fmt::format(" ({} without locks)", replications_words(*unlocked)) : "");
}

Figure precision_figure(const ScenarioFacts& scenario, const Looks& looks) {
    Range replications;
    Range widths;
    widths.include(0.0);
    widths.include(scenario.least_relevant_s);
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.precision) continue;
        for (const PrecisionPoint& point : condition.precision->points) {
            replications.include(static_cast<double>(point.replications));
            widths.include(point.half_width_s);
        }
    }
    if (replications.empty()) return {};
    constexpr double least_width = 5.0;  // so that the ticks are whole numbers
    replications.high = std::max(replications.high, replications.low + least_width);
    widths.high *= 1.05;
    DataTable data{{"Condition, replications", labelled(primary, "half width of the interval")}, {}};
    std::vector<std::size_t> drawn;
    std::vector<Points> lines(scenario.conditions.size());
    for (std::size_t row = 0; row < lines.size(); ++row) {
        const ConditionFacts& condition = scenario.conditions[row];
        if (!condition.precision || condition.precision->points.empty()) continue;
        for (const PrecisionPoint& point : condition.precision->points) {
            lines[row].emplace_back(static_cast<double>(point.replications), point.half_width_s);
            data.rows.push_back({fmt::format("{}, {}", condition.label(), point.replications),
                                 number(point.half_width_s, typeset(2))});
        }
        drawn.push_back(row);
    }
    const std::string note = fmt::format("The level line is the smallest difference that counts, {} s.",
                                         number(scenario.least_relevant_s, typeset(1)));
    return {"precision-" + scenario.name, scenario.name,
            line_figure(
                {fmt::format("{}: width of the interval over replications", scenario.name),
                 270.0,
                 {replications, "replications, number"},
                 {widths, labelled(primary, "half width of the interval")},
                 scenario.least_relevant_s > 0.0 ? std::optional(scenario.least_relevant_s) : std::nullopt},
                scenario, looks, drawn,
                [&](Plot& plot, std::size_t place, std::size_t /*slot*/, const Series& series) {
                    plot.line(lines[place], series);
                }),
            note, std::move(data)};
}

DataTable precision_table(const ScenarioFacts& scenario) {
    const double wanted_s =
        scenario.least_relevant_s > 0.0 ? scenario.least_relevant_s : usual_least_relevant_s;
    DataTable table{{"Condition", "complete pairs", "deviation of the differences, s", "half width, s",
                     fmt::format("replications for \u00b1{} s", number(wanted_s, typeset(1)))},
                    {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.is_compared()) continue;
        const MaybeEstimate& difference = condition.difference(Measure::emergency_restricted_time);
        const analysis::Interval* const interval = shown_interval(difference);
        const auto& precision = condition.precision;
        table.rows.push_back(
            {condition.label(), grouped(difference ? difference->n : 0),
             precision ? number(precision->deviation_s, typeset(1)) : missing(Script::typeset),
             interval != nullptr ? number((interval->high - interval->low) / 2.0, typeset(2))
                                 : missing(Script::typeset),
             replications_needed(condition)});
    }
    return table;
}

}  // namespace

void enough_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>Half the width of the 95 % interval of the EV travel time difference, as replications were "
        "added. Where the curve is below the line, differences as small as the line can be detected. If an "
        "effect is shown, n is enough from ten on, if it was chosen before and for one comparison; among "
        "several, p (Holm) decides. The last column gives the number "
        "of replications for an interval as narrow as the line "
        "(FHWA: n = (t s / e)\u00b2, at least 10).</p>\n");
    writer.figures(figures_of(study, precision_figure));
    for (const ScenarioFacts& scenario : study.scenarios)
        writer.table({"replications-" + scenario.name, scenario.name + ": replications needed",
                      precision_table(scenario)});
}

}  // namespace clearway::report::detail
