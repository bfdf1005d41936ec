#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::array forest_measures = {Measure::emergency_restricted_time, Measure::emergency_waiting_time,
                                        Measure::other_time_loss};
constexpr double forest_right = 250.0;  // the numbers are to the right of the drawing
constexpr double heading_height = 28.0;
constexpr double row_height = 34.0;

Range forest_range(const ScenarioFacts& scenario, std::size_t& compared) {
    Range range;
    range.include(0.0);
    compared = 0;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.is_compared()) continue;
        ++compared;
        for (const Measure measure : forest_measures) {
            const Estimate& difference = condition.outcome(measure).difference;
            if (difference.mean) range.include(*difference.mean);
            if (difference.has_interval()) {
                range.include(*difference.low);
                range.include(*difference.high);
            }
        }
    }
    return range;
}

void draw_forest_row(Plot& plot, const ConditionFacts& condition, const Outcome& outcome, double top,
                     std::size_t series) {
    const Estimate& difference = outcome.difference;
    plot.text(10.0, top + 11.0, condition.label(), Plot::Anchor::start, "label");
    plot.text(right_edge, top + 26.0, estimate(difference, typeset(1, Sign::always)), Plot::Anchor::end,
              "value");
    if (!difference.mean) return;
    if (difference.has_interval()) {
        plot.interval({*difference.low, *difference.high}, *difference.mean, top + 22.0, series);
    } else {
        plot.point(*difference.mean, top + 22.0, series);
    }
}

DataTable forest_data(const ScenarioFacts& scenario) {
    DataTable table{{"Measure, condition", "difference, s", "low 95 %", "high 95 %", "pairs"}, {}};
    for (const Measure measure : forest_measures) {
        for (const ConditionFacts& condition : scenario.conditions) {
            if (!condition.is_compared()) continue;
            const Estimate& difference = condition.outcome(measure).difference;
            const NumberStyle style = typeset(2, Sign::always);
            table.rows.push_back({fmt::format("{}, {}", info(measure).title, condition.label()),
                                  cell(difference.mean, style), cell(difference.low, style),
                                  cell(difference.high, style), grouped(difference.count)});
        }
    }
    return table;
}

Figure forest_figure(const ScenarioFacts& scenario) {
    std::size_t compared = 0;
    const Range range = forest_range(scenario, compared);
    if (compared == 0) return {};
    const double rows = static_cast<double>(compared * forest_measures.size()) * row_height +
                        heading_height * forest_measures.size();
    const double height = rows + 10.0 + label_space;
    Plot plot(fmt::format("{}: paired differences to the baseline", scenario.name), height,
              {padded(range, 0.06), "difference to the baseline, s", 10.0, forest_right},
              {{}, "", 6.0, height - label_space});
    plot.grid_x();
    plot.vertical(0.0);
    double top = 6.0;
    for (const Measure measure : forest_measures) {
        plot.text(10.0, top + 18.0, info(measure).title, Plot::Anchor::start, "heading");
        top += heading_height;
        for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
            const ConditionFacts& condition = scenario.conditions[row];
            if (!condition.is_compared()) continue;
            draw_forest_row(plot, condition, condition.outcome(measure), top, row);
            top += row_height;
        }
    }
    return {"differences-" + scenario.name, scenario.name, plot.finish(), "", forest_data(scenario)};
}

}  // namespace

void differences_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>Mean of the paired differences with its 95 % interval. Left of the line a condition takes "
        "less time than the baseline, right of it more. The gain of the EVs and the cost to the others "
        "share one axis.</p>\n");
    writer.figures(figures_of(study, forest_figure));
}

}  // namespace clearway::report::detail
