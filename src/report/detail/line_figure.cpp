// Lines of the conditions of a scenario: in one chart, or in panels where one would hold too many.
#include <algorithm>
#include <utility>

#include "report/detail/figures.hpp"

namespace clearway::report::detail {
namespace {

struct Line {
    std::size_t place = 0;
    std::size_t slot = 0;
    Series series;
};

struct Panel {
    std::string heading;  ///< Empty where it is the only one.
    std::vector<Line> lines;
};

/// Whether a crossing gives the condition its panel; what it does not is in each.
bool has_panel(const Series& series) {
    return series.levels && series.levels->colour > 0;
}

void add_line(std::size_t place, const Series& series, Panel& panel) {
    panel.lines.push_back({place, panel.lines.size(), series});
}

std::vector<Panel> panels_of(const Looks& looks, const std::vector<std::size_t>& drawn) {
    std::vector<Panel> shown(1);
    if (!looks.crossing) {
        for (const std::size_t place : drawn)
            add_line(place, looks[place], shown.front());
        return shown;
    }
    shown.clear();
    const std::vector<std::string>& headings = looks.crossing->mark.levels;
    for (std::size_t level = 1; level <= headings.size(); ++level) {
        Panel panel{headings[level - 1], {}};
        for (const std::size_t place : drawn) {
            Series series = looks[place];
            if (has_panel(series) && series.levels->mark != level) continue;
            if (has_panel(series)) series.levels->mark = 0;  // the heading says it
            add_line(place, series, panel);
        }
        const bool is_needed =
            std::ranges::any_of(panel.lines, [](const Line& line) { return has_panel(line.series); });
        if (is_needed) shown.push_back(std::move(panel));
    }
    return shown;
}

std::vector<LegendEntry> entries_of(const ScenarioFacts& scenario, const Looks& looks,
                                    const std::vector<std::size_t>& drawn) {
    std::vector<LegendEntry> entries;
    for (const std::size_t place : drawn)
        if (!looks.crossing || !has_panel(looks[place]))
            entries.push_back(line_entry(looks[place], scenario.conditions[place].label()));
    if (!looks.crossing) return entries;
    const std::vector<std::string>& words = looks.crossing->colour.levels;
    for (std::size_t level = 1; level <= words.size(); ++level) {
        const bool is_drawn = std::ranges::any_of(drawn, [&](std::size_t place) {
            return has_panel(looks[place]) && looks[place].levels->colour == level;
        });
        if (is_drawn) entries.push_back(line_entry({.levels = Series::Levels{level, 0}}, words[level - 1]));
    }
    return entries;
}

void draw_panel(Plot& plot, const LineFigure& figure, Panel panel, const DrawLine& draw) {
    if (!panel.heading.empty())
        plot.text(plot.x().from, plot.y().to - 6.0, shortened(panel.heading, 24), Plot::Anchor::start,
                  "heading");
    if (figure.level) plot.horizontal(*figure.level);
    std::stable_partition(panel.lines.begin(), panel.lines.end(),
                          [](const Line& line) { return line.series.weight == Series::Weight::usual; });
    for (const Line& line : panel.lines)
        draw(plot, line.place, line.slot, line.series);
}

}  // namespace

std::string line_figure(const LineFigure& figure, const ScenarioFacts& scenario, const Looks& looks,
                        const std::vector<std::size_t>& drawn, const DrawLine& draw) {
    const std::vector<Panel> shown = panels_of(looks, drawn);
    Axis x = figure.x;
    if (x.scale == Scale::slots) {
        std::size_t most = 1;
        for (const Panel& panel : shown)
            most = std::max(most, panel.lines.size());
        x.values = Range(0.0, static_cast<double>(most));
    }
    std::vector<LegendEntry> entries = entries_of(scenario, looks, drawn);
    if (!looks.crossing) {
        Chart plot(figure.title, figure.height, x, figure.y);
        draw_panel(plot, figure, shown.front(), draw);
        plot.legend(entries);
        return plot.finish();
    }
    return panels({figure.title, figure.y.label, x.label, std::move(entries)}, shown.size(), x, figure.y,
                  [&](Plot& plot, std::size_t panel) { draw_panel(plot, figure, shown[panel], draw); });
}

}  // namespace clearway::report::detail
