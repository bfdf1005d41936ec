#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/grid.hpp"
#include "report/detail/panels.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::size_t drawn_approaches = 8;  // those with the largest changes; the data list more
constexpr std::size_t listed_approaches = 100;

std::string name_of(const ApproachFacts& approach) {
    return approach.street.empty() ? approach.edge : fmt::format("{} ({})", approach.street, approach.edge);
}

DataTable approach_data(const ScenarioFacts& scenario) {
    DataTable table{{"Approach", "condition", "time lost, s per run [95 %]", "human-driven", "automated",
                     "waiting time", "baseline, s per run", "vehicles per run", "per vehicle, s"},
                    {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        const std::size_t listed = std::min(condition.approaches.size(), listed_approaches);
        for (std::size_t row = 0; row < listed; ++row) {
            const ApproachFacts& approach = condition.approaches[row];
            const NumberStyle style = typeset(0, Sign::always);
            table.rows.push_back({name_of(approach), condition.label(), estimate(approach.difference, style),
                                  estimate(approach.human, style), estimate(approach.automated, style),
                                  estimate(approach.waiting, style), cell(approach.baseline_s, typeset(0)),
                                  cell(approach.vehicles, typeset(1)),
                                  cell(approach.per_vehicle_s, typeset(2, Sign::always))});
        }
    }
    return table;
}

/// The approaches with the largest changes under any condition, the largest first.
std::vector<const ApproachFacts*> largest_approaches(const ScenarioFacts& scenario) {
    std::map<std::string, const ApproachFacts*> largest;
    const auto change = [](const ApproachFacts* approach) {
        return std::abs(approach->difference.mean.value_or(0.0));
    };
    for (const ConditionFacts& condition : scenario.conditions) {
        for (const ApproachFacts& approach : condition.approaches) {
            const ApproachFacts*& known = largest[approach.edge];
            if (known == nullptr || change(&approach) > change(known)) known = &approach;
        }
    }
    std::vector<const ApproachFacts*> sorted;
    for (const auto& [edge, approach] : largest)
        sorted.push_back(approach);
    std::ranges::stable_sort(sorted, std::greater{}, change);
    return sorted;
}

GridCell cost_cell(const ConditionFacts& condition, const std::string& edge) {
    const auto found = std::ranges::find(condition.approaches, edge, &ApproachFacts::edge);
    if (found == condition.approaches.end() || !found->difference.mean) return {};
    const Estimate& difference = found->difference;
    const bool claims = difference.has_interval();
    const bool better = claims && *difference.high < 0.0 && !condition.objections.on_others();
    return {number(*difference.mean, typeset(0, Sign::always)), better ? GridCell::Tone::better
                                                                : claims && *difference.low > 0.0
                                                                    ? GridCell::Tone::worse
                                                                    : GridCell::Tone::neutral};
}

/// Conditions with costs, by their places in the scenario.
std::vector<std::size_t> costly_conditions(const ScenarioFacts& scenario) {
    std::vector<std::size_t> numbers;
    for (std::size_t number = 0; number < scenario.conditions.size(); ++number) {
        if (!scenario.conditions[number].approaches.empty()) numbers.push_back(number);
    }
    return numbers;
}

/// Time lost on each approach against the baseline: a row an approach, a column a condition.
Figure approach_figure(const ScenarioFacts& scenario) {
    const std::vector<const ApproachFacts*> approaches = largest_approaches(scenario);
    if (approaches.empty()) return {};
    const std::size_t shown = std::min(approaches.size(), drawn_approaches);
    const std::vector<std::size_t> numbers = costly_conditions(scenario);
    std::vector<Grid> grids;
    for (std::size_t first = 0; first < numbers.size(); first += most_grid_columns) {
        Grid& grid = grids.emplace_back();
        const std::size_t end = std::min(numbers.size(), first + most_grid_columns);
        for (std::size_t at = first; at < end; ++at)
            grid.columns.push_back(std::to_string(numbers[at]));
        for (std::size_t row = 0; row < shown; ++row) {
            Grid::Row& cells = grid.rows.emplace_back(Grid::Row{name_of(*approaches[row]), {}});
            for (std::size_t at = first; at < end; ++at)
                cells.cells.push_back(cost_cell(scenario.conditions[numbers[at]], approaches[row]->edge));
        }
    }
    double height = 0.0;
    for (const Grid& grid : grids)
        height += grid_height(grid);
    Canvas canvas(fmt::format("{}: time lost by approach against the baseline", scenario.name), height);
    double top = 0.0;
    for (const Grid& grid : grids) {
        draw_grid(grid, top, canvas);
        top += grid_height(grid);
    }
    std::vector<LegendEntry> entries;
    for (const std::size_t number : numbers)
        entries.push_back(number_entry(number, scenario.conditions[number].label()));
    canvas.legend(entries);
    std::string note =
        "Time lost on the approach against the baseline, s per run, summed over all vehicles that are not "
        "EVs. Coloured if the 95 % interval excludes 0.";
    if (approaches.size() > shown)
        note += fmt::format(" Shown are the {} of {} approaches with the largest changes.", shown,
                            approaches.size());
    return {"cost-" + scenario.name, scenario.name, canvas.finish(), note, approach_data(scenario)};
}

bool has_recovery(const ScenarioFacts& scenario) {
    return std::ranges::any_of(scenario.conditions,
                               [](const ConditionFacts& condition) { return !condition.recovery.empty(); });
}

void draw_recovery(Plot& plot, const ConditionFacts& condition, std::size_t series) {
    plot.grid_x();
    plot.grid_y();
    plot.horizontal(0.0);
    plot.vertical(0.0);
    std::vector<std::pair<double, double>> means;
    std::vector<std::array<double, 3>> bounds;
    for (const RecoveryFacts& point : condition.recovery) {
        means.emplace_back(point.offset_s, point.halted.mean.value_or(0.0));
        if (point.halted.has_interval())
            bounds.push_back({point.offset_s, *point.halted.low, *point.halted.high});
    }
    plot.band(bounds, series);
    plot.line(means, series);
    plot.text(plot.x().from, plot.y().to - 19.0, shortened(condition.label(), 15), Plot::Anchor::start,
              "heading");
    plot.text(plot.x().from, plot.y().to - 6.0,
              condition.recovered_after_s
                  ? fmt::format("recovered after {} s", number(*condition.recovered_after_s, typeset(0)))
                  : "not recovered in this time",
              Plot::Anchor::start, "label");
}

Figure recovery_figure(const ScenarioFacts& scenario) {
    Range offsets;
    Range halted;
    halted.include(0.0);
    std::vector<std::size_t> numbers;
    DataTable data{{"Condition", "s after the EV", "more halted vehicles [95 %]"}, {}};
    for (std::size_t number = 0; number < scenario.conditions.size(); ++number) {
        const ConditionFacts& condition = scenario.conditions[number];
        if (!condition.recovery.empty()) numbers.push_back(number);
        for (const RecoveryFacts& point : condition.recovery) {
            offsets.include(point.offset_s);
            for (const auto& value : {point.halted.mean, point.halted.low, point.halted.high})
                halted.include(value.value_or(0.0));
            data.rows.push_back({condition.label(), report::number(point.offset_s, typeset(0)),
                                 estimate(point.halted, typeset(2, Sign::always))});
        }
    }
    if (offsets.empty() || offsets.high <= offsets.low) return {};
    const double rows = std::ceil(static_cast<double>(numbers.size()) / panel_columns);
    Plot plot(fmt::format("{}: halted vehicles on the other approaches after an EV", scenario.name),
              panels_top + rows * panel_below, {}, {});
    plot.text(2.0, 14.0, "halted vehicles above the baseline; across: s after an EV", Plot::Anchor::start,
              "axis");
    for (std::size_t panel = 0; panel < numbers.size(); ++panel) {
        const auto [left, top] = panel_place(panel);
        plot.turn_to({offsets, "", left, left + panel_width},
                     {padded(halted, 0.06), "", top + panel_height, top});
        draw_recovery(plot, scenario.conditions[numbers[panel]], numbers[panel]);
    }
    return {"recovery-" + scenario.name, scenario.name, plot.finish(),
            "Halted vehicles on the signal's other approaches around each passage of an EV, compared with "
            "the passages of the baseline, with 95 % intervals. Recovered: from then on no interval lies "
            "above 0 for 30 s.",
            std::move(data)};
}

}  // namespace

void cost_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>Who pays for the EVs\u2019 gain: time lost by all other vehicles on each approach to a "
        "signal (on each edge if a network has no signals), from a minute before the first EV, compared "
        "with the baseline of the same replication. With many approaches, one interval in twenty "
        "excludes 0 by chance.</p>\n");
    writer.figures(figures_of(study, approach_figure));
    if (std::ranges::none_of(study.scenarios, has_recovery)) return;
    writer.heading("Recovery after an EV");
    writer.figures(figures_of(study, recovery_figure));
}

}  // namespace clearway::report::detail
