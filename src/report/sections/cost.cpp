#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
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

using analysis::ApproachCost;

constexpr std::size_t drawn_approaches = 8;  // those with the largest changes; the data list more
constexpr std::size_t listed_approaches = 100;

DataTable approach_data(const ScenarioFacts& scenario) {
    DataTable table{{"Approach", "condition", "time lost, s per run [95 %]", "human-driven", "automated",
                     "waiting time", "the baseline, s per run", "vehicles per run", "per vehicle, s"},
                    {}};
    const NumberStyle style = typeset(0, Sign::always);
    for (const ConditionFacts& condition : scenario.conditions) {
        const std::size_t listed = std::min(condition.approaches.size(), listed_approaches);
        for (std::size_t row = 0; row < listed; ++row) {
            const ApproachCost& approach = condition.approaches[row];
            table.rows.push_back({scenario.place_name(approach.edge), condition.label(),
                                  estimate(approach.difference, style), estimate(approach.human, style),
                                  estimate(approach.automated, style), estimate(approach.waiting, style),
                                  number_or_dash(approach.baseline_s, typeset(0)),
                                  number_or_dash(approach.vehicles, typeset(1)),
                                  number_or_dash(approach.per_vehicle_s, typeset(2, Sign::always))});
        }
    }
    return table;
}

/// The approaches with the largest changes under any condition, the largest first.
std::vector<const ApproachCost*> largest_approaches(const ScenarioFacts& scenario) {
    std::map<std::string, const ApproachCost*> largest;
    const auto change = [](const ApproachCost* approach) {
        return std::abs(mean_of(approach->difference).value_or(0.0));
    };
    for (const ConditionFacts& condition : scenario.conditions) {
        for (const ApproachCost& approach : condition.approaches) {
            const ApproachCost*& known = largest[approach.edge];
            if (known == nullptr || change(&approach) > change(known)) known = &approach;
        }
    }
    std::vector<const ApproachCost*> sorted;
    for (const auto& [edge, approach] : largest)
        sorted.push_back(approach);
    std::ranges::stable_sort(sorted, std::greater{}, change);
    return sorted;
}

GridCell cost_cell(const ConditionFacts& condition, const std::string& edge) {
    const auto found = std::ranges::find(condition.approaches, edge, &ApproachCost::edge);
    if (found == condition.approaches.end() || !found->difference) return {};
    const analysis::Interval* const interval = shown_interval(found->difference);
    const bool better = interval != nullptr && interval->high < 0.0 && !condition.objections.on_others();
    const bool worse = interval != nullptr && interval->low > 0.0;
    return {number(found->difference->mean, typeset(0, Sign::always)) +
                alone_mark(found->difference, found->holm_p),
            better  ? GridCell::Tone::better
            : worse ? GridCell::Tone::worse
                    : GridCell::Tone::neutral,
            interval == nullptr ? "" : interval_text(*interval, typeset(0))};
}

/// Time lost on each approach against the baseline: a row an approach, a column a condition.
Figure approach_figure(const ScenarioFacts& scenario, const Looks& looks) {
    const std::vector<const ApproachCost*> approaches = largest_approaches(scenario);
    if (approaches.empty()) return {};
    const std::size_t shown = std::min(approaches.size(), drawn_approaches);
    Grid grid;
    for (std::size_t row = 0; row < shown; ++row)
        grid.rows.push_back({scenario.place_name(approaches[row]->edge), {}});
    std::vector<LegendEntry> entries;
    for (std::size_t number = 0; number < scenario.conditions.size(); ++number) {
        const ConditionFacts& condition = scenario.conditions[number];
        if (condition.approaches.empty()) continue;
        grid.columns.push_back(std::to_string(number));
        entries.push_back(number_entry(looks[number], condition.label()));
        for (std::size_t row = 0; row < shown; ++row)
            grid.rows[row].cells.push_back(cost_cell(condition, approaches[row]->edge));
    }
    const std::vector<Grid> grids = {grid};
    Canvas canvas = draw_grids(fmt::format("{}: time lost by approach against the baseline", scenario.name),
                               grids, {"time lost by others per approach and run: difference [95 %], s"});
    canvas.legend(tone_entries(grids));
    canvas.legend(entries);
    std::string note =
        "Time lost on the approach against the baseline, s per run, summed over all vehicles that are not "
        "EVs. Coloured if the 95 % interval excludes 0; ? if it does not with Holm's correction for all "
        "approaches and conditions.";
    if (approaches.size() > shown)
        note += fmt::format(" Shown are the {} of {} approaches with the largest changes.", shown,
                            approaches.size());
    return {"cost-" + scenario.name, scenario.name, canvas.finish(), note, approach_data(scenario)};
}

std::string recovery_words(const analysis::Recovery& recovery) {
    if (recovery.recovered_by_s)
        return fmt::format("recovered by {} s", number(*recovery.recovered_by_s, typeset(0)));
    if (recovery.stays_longer) return "not recovered in this time";
    if (!recovery.pairs_to_tell) return "not told yet";
    const std::string seeds = *recovery.pairs_to_tell > most_replications_asked
                                  ? fmt::format("over {}", most_replications_asked)  // a panel is narrow
                                  : asked_words(*recovery.pairs_to_tell);
    return fmt::format("not told yet: {} seeds", seeds);
}

void draw_recovery(Plot& plot, const ConditionFacts& condition, const Series& series) {
    plot.horizontal(0.0);
    plot.horizontal(analysis::recovered_within_vehicles);
    plot.vertical(0.0);
    Points means;
    std::vector<std::array<double, 3>> bounds;
    for (const analysis::RecoveryPoint& point : condition.recovery->points) {
        means.emplace_back(point.offset_s, mean_of(point.difference).value_or(0.0));
        if (const analysis::Interval* const interval = shown_interval(point.difference))
            bounds.push_back({point.offset_s, interval->low, interval->high});
    }
    plot.band(bounds, series);
    plot.line(means, series);
    plot.add(fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>", plot.x().from - 12.0,
                         plot.y().to - 16.0, number_entry(series, {}).mark));
    plot.text(plot.x().from + 22.0, plot.y().to - 7.0,
              bounds.empty() ? "too few passages to tell" : recovery_words(*condition.recovery),
              Plot::Anchor::start, "label");
}

/// Of the conditions `numbers`; all figures of a scenario have the same axes.
Figure recovery_figure(const ScenarioFacts& scenario, const Looks& looks,
                       std::span<const std::size_t> numbers, const Range& offsets, const Range& halted) {
    DataTable data{{"Condition", "s after the EV", "more halted vehicles [95 %]"}, {}};
    std::vector<LegendEntry> entries;
    for (const std::size_t number : numbers) {
        const ConditionFacts& condition = scenario.conditions[number];
        entries.push_back(number_entry(looks[number], condition.label()));
        for (const analysis::RecoveryPoint& point : condition.recovery->points)
            data.rows.push_back({condition.label(), report::number(point.offset_s, typeset(0)),
                                 estimate(point.difference, typeset(2, Sign::always))});
    }
    return {"recovery-" + scenario.name, scenario.name,
            panels({fmt::format("{}: halted vehicles on the other approaches after an EV", scenario.name),
                    "more halted vehicles, number", "time after an EV, s", std::move(entries)},
                   numbers.size(), {offsets, ""}, {padded(halted, 0.06), ""},
                   [&](Plot& plot, std::size_t panel) {
                       draw_recovery(plot, scenario.conditions[numbers[panel]], looks[numbers[panel]]);
                   }),
            "Halted vehicles on the signal's other approaches around each passage of an EV, compared with "
            "the passages of the baseline, with 95 % intervals. Recovered: from then on intervals stay below "
            "one more vehicle, the upper level line, for 30 s. Not recovered: in every 30 s one lies above "
            "it. Not told yet: neither is shown; so many seeds would show recovery if means and deviations "
            "stayed.",
            std::move(data)};
}

void add_recovery_figures(const ScenarioFacts& scenario, const Looks& looks, std::vector<Figure>& figures) {
    Range offsets;
    Range halted;
    halted.include(0.0);
    halted.include(analysis::recovered_within_vehicles);
    std::vector<std::size_t> numbers;
    for (std::size_t number = 0; number < scenario.conditions.size(); ++number) {
        if (!scenario.conditions[number].recovery) continue;
        numbers.push_back(number);
        for (const analysis::RecoveryPoint& point : scenario.conditions[number].recovery->points) {
            offsets.include(point.offset_s);
            halted.include_all(point.difference);
        }
    }
    if (offsets.empty() || offsets.high <= offsets.low) return;
    constexpr std::size_t most_panels = 6;  // a page of a paper holds so many
    const std::size_t count = (numbers.size() + most_panels - 1) / most_panels;
    for (std::size_t part = 0; part < count; ++part) {
        const std::size_t first = part * most_panels;
        const std::size_t size = std::min(most_panels, numbers.size() - first);
        figures.push_back(
            recovery_figure(scenario, looks, std::span(numbers).subspan(first, size), offsets, halted));
        if (count == 1) continue;
        figures.back().name += fmt::format("-{}", part + 1);
        figures.back().caption += fmt::format(" ({} of {})", part + 1, count);
    }
}

std::vector<Figure> recovery_figures(const StudyFacts& study) {
    std::vector<Figure> figures;
    for (const ScenarioFacts& scenario : study.scenarios)
        add_recovery_figures(scenario, looks_of(study, scenario), figures);
    return figures;
}

}  // namespace

void cost_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>Cost of the EVs\u2019 gain: time lost by all other vehicles on each approach to a signal (on "
        "each edge if a network has no signals), from a minute before the first EV, compared with the "
        "baseline of the same replication. With many approaches, one interval in twenty excludes 0 by "
        "chance.</p>\n");
    writer.figures(figures_of(study, approach_figure));
    const bool has_recovery = std::ranges::any_of(study.scenarios, [](const ScenarioFacts& scenario) {
        return std::ranges::any_of(scenario.conditions,
                                   [](const ConditionFacts& one) { return one.recovery.has_value(); });
    });
    if (!has_recovery) return;
    writer.heading("Recovery after an EV");
    writer.figures(recovery_figures(study));
}

}  // namespace clearway::report::detail
