#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/grid.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::array forest_measures = {Measure::emergency_restricted_time, Measure::emergency_waiting_time,
                                        Measure::other_time_loss};
constexpr double forest_right = 250.0;  // the numbers are to the right of the drawing
constexpr double heading_height = 28.0;
constexpr double row_height = 34.0;
constexpr std::ptrdiff_t most_rows = 6;  ///< With more conditions, each measure has a figure of its own.

Range forest_range(const ScenarioFacts& scenario) {
    Range range;
    range.include(0.0);
    for (const ConditionFacts& condition : scenario.conditions) {
        for (const Measure measure : forest_measures)
            range.include(condition.difference(measure));
    }
    return range;
}

void draw_forest_row(Plot& plot, const ConditionFacts& condition, Measure measure, double top,
                     const Series& series) {
    const MaybeEstimate& difference = condition.difference(measure);
    plot.text(10.0, top + 11.0, condition.label(), Plot::Anchor::start,
              series.weight == Series::Weight::lead ? "label lead" : "label");
    plot.text(right_edge, top + 26.0,
              estimate(difference, typeset(1, Sign::always)) + alone_mark(condition, measure),
              Plot::Anchor::end, "value");
    plot.estimate(difference, shown_interval(difference), top + 22.0, series);
}

DataTable forest_data(const ScenarioFacts& scenario, std::span<const Measure> measures) {
    DataTable table{{"Measure, condition", "difference, s", "low 95 %", "high 95 %", "pairs"}, {}};
    for (const Measure measure : measures) {
        for (const ConditionFacts& condition : scenario.conditions) {
            if (!condition.is_compared()) continue;
            const MaybeEstimate& difference = condition.difference(measure);
            const NumberStyle style = typeset(2, Sign::always);
            const auto end = [&](double analysis::Interval::*side) {
                return difference && difference->interval ? number(*difference->interval.*side, style)
                                                          : missing(style.script);
            };
            table.rows.push_back({fmt::format("{}, {}", info(measure).title, condition.label()),
                                  number_or_dash(mean_of(difference), style), end(&analysis::Interval::low),
                                  end(&analysis::Interval::high), grouped(difference ? difference->n : 0)});
        }
    }
    return table;
}

std::ptrdiff_t compared_in(const ScenarioFacts& scenario) {
    return std::ranges::count_if(scenario.conditions, &ConditionFacts::is_compared);
}

/// `name`: of its files.
Figure forest_figure(const ScenarioFacts& scenario, const Looks& looks, std::span<const Measure> measures,
                     const std::string& name) {
    const double rows = static_cast<double>(compared_in(scenario)) * row_height + heading_height;
    const double height = static_cast<double>(measures.size()) * rows + 10.0 + label_space;
    Plot plot(fmt::format("{}: paired differences to the baseline", scenario.name), height,
              {padded(forest_range(scenario), 0.06), "difference to the baseline (left: better), s", 10.0,
               forest_right},
              {{}, "", 6.0, height - label_space});
    plot.grid_x();
    plot.vertical(0.0);
    double top = 6.0;
    bool is_marked = false;
    for (const Measure measure : measures) {
        plot.text(10.0, top + 18.0, info(measure).title, Plot::Anchor::start, "heading");
        top += heading_height;
        for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
            const ConditionFacts& condition = scenario.conditions[row];
            if (!condition.is_compared()) continue;
            draw_forest_row(plot, condition, measure, top, looks[row]);
            is_marked = is_marked || *alone_mark(condition, measure) != '\0';
            top += row_height;
        }
    }
    if (is_marked) plot.legend({{"", shown_alone_words}});
    return {name, scenario.name, plot.finish(), "", forest_data(scenario, measures)};
}

std::vector<Figure> forest_figures(const StudyFacts& study) {
    std::vector<Figure> figures;
    for (const ScenarioFacts& scenario : study.scenarios) {
        const Looks looks = looks_of(study, scenario);
        const std::string name = "differences-" + scenario.name;
        const std::ptrdiff_t compared = compared_in(scenario);
        if (compared > 0 && compared <= most_rows)
            figures.push_back(forest_figure(scenario, looks, forest_measures, name));
        if (compared <= most_rows) continue;
        for (const Measure& measure : forest_measures) {
            figures.push_back(forest_figure(scenario, looks, {&measure, 1},
                                            fmt::format("{}-{}", name, info(measure).field)));
            figures.back().caption += fmt::format(": {}", info(measure).title);
        }
    }
    return figures;
}

}  // namespace

void differences_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>Mean of the paired differences with its 95 % interval. Left of the line a condition takes "
        "less time than the baseline, right of it more. The gain of the EVs and the cost to the others "
        "share one axis.</p>\n");
    writer.figures(forest_figures(study));
}

}  // namespace clearway::report::detail
