// Benefit against failure: what is left of a policy's benefit when vehicles go dark, and the believed links
// behind it.

#include <cmath>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/panels.hpp"
#include "report/failure_curve.hpp"
#include "report/sections/sections.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr double percent = 100.0;
using Member = std::optional<analysis::Estimate> FailurePoint::*;

void include(const analysis::Estimate& estimate, Range& range) {
    range.include(estimate.mean);
    if (!estimate.interval) return;
    range.include(estimate.interval->low);
    range.include(estimate.interval->high);
}

DataTable data_of(const FailureCurve& curve) {
    DataTable table{{"Repair", "dark, %", "EV travel time, difference, s", "pairs", "link F1"}, {}};
    for (const FailureLine& line : curve.lines) {
        for (const FailurePoint& point : line.points) {
            table.rows.push_back(
                {line.repair, number(percent * point.dark_share, {.decimals = 0, .script = Script::typeset}),
                 estimate(point.travel_time,
                          {.decimals = 2, .script = Script::typeset, .sign = Sign::always}),
                 point.travel_time ? grouped(point.travel_time->n) : missing(Script::typeset),
                 estimate(point.link_f1, {.decimals = 3, .script = Script::typeset})});
        }
    }
    return table;
}

struct Ranges {
    Range shares;
    Range values;
};

/// Of all lines, so that the panels have one scale.
Ranges ranges_of(const FailureCurve& curve, Member member) {
    Ranges ranges;
    if (member == &FailurePoint::travel_time) ranges.values.include(0.0);
    for (const FailureLine& line : curve.lines) {
        for (const FailurePoint& point : line.points) {
            ranges.shares.include(percent * point.dark_share);
            if (point.*member) include(*(point.*member), ranges.values);
        }
    }
    return ranges;
}

std::vector<std::pair<double, double>> means_of(const FailureLine& line, Member member) {
    std::vector<std::pair<double, double>> means;
    for (const FailurePoint& point : line.points) {
        if (point.*member) means.emplace_back(percent * point.dark_share, (point.*member)->mean);
    }
    return means;
}

void draw_panel(Plot& plot, const FailureCurve& curve, const FailureLine& own, Member member) {
    plot.grid_x();
    plot.grid_y();
    if (member == &FailurePoint::travel_time) plot.horizontal(0.0);
    plot.text(plot.x().from, plot.y().to - 6.0, shortened(own.repair, 15), Plot::Anchor::start, "heading");
    for (const FailureLine& line : curve.lines)
        plot.hair(means_of(line, member), 0);
    for (const FailurePoint& point : own.points) {
        if (!(point.*member) || !(point.*member)->interval) continue;
        const analysis::Interval& interval = *(point.*member)->interval;
        plot.whisker(percent * point.dark_share, {interval.low, interval.high}, 1);
    }
    plot.line(means_of(own, member), 1);
}

/// One estimate over the share of time dark: a panel for each repair, with the others thin behind it.
Figure panels(const FailureCurve& curve, Member member, const char* name, const std::string& label) {
    const Ranges ranges = ranges_of(curve, member);
    if (ranges.values.empty()) return {};
    const double rows = std::ceil(static_cast<double>(curve.lines.size()) / panel_columns);
    const std::string title = fmt::format("{}, policy {}: {}", curve.scenario, curve.policy, label);
    Plot plot(title, panels_top + rows * panel_below, {}, {});
    plot.text(2.0, 14.0, label + "; across: time dark, %", Plot::Anchor::start, "axis");
    for (std::size_t number = 0; number < curve.lines.size(); ++number) {
        const auto [left, top] = panel_place(number);
        plot.turn_to({padded(ranges.shares, 0.08), "", left, left + panel_width},
                     {padded(ranges.values, 0.06), "", top + panel_height, top});
        draw_panel(plot, curve, curve.lines[number], member);
    }
    return {fmt::format("{}-{}-{}", name, curve.scenario, curve.policy), title, plot.finish(),
            curve.failure.empty() ? "" : "Failure: " + curve.failure + ".", data_of(curve)};
}

DataTable break_even_table(const StudyFacts& study) {
    DataTable table{{"Scenario, policy, repair", "benefit shown up to", "not shown from", "link F1 there"},
                    {}};
    const auto dark = [](const FailurePoint& point) {
        return number(percent * point.dark_share, {.decimals = 0, .script = Script::typeset}) + " %";
    };
    for (const FailureCurve& curve : study.failure_curves) {
        for (const FailureLine& line : curve.lines) {
            const std::size_t first = line.break_even.value_or(line.points.size());
            const std::string name = fmt::format("{}, {}, {}", curve.scenario, curve.policy, line.repair);
            const bool ends = line.break_even.has_value();
            table.rows.push_back(
                {name, first == 0 ? missing(Script::typeset) : dark(line.points[first - 1]),
                 ends ? dark(line.points[first]) : missing(Script::typeset),
                 ends ? estimate(line.points[first].link_f1, {.decimals = 3, .script = Script::typeset})
                      : missing(Script::typeset)});
        }
    }
    return table;
}

}  // namespace

void failure_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>What is left of a policy\u2019s benefit when vehicles are dark for a share of the time, and how "
        "accurate the believed links were meanwhile (F1 end to end: links of vehicles never seen count as "
        "missed). Below 0, EVs are faster than without the policy. The bars are 95 % intervals of the "
        "paired differences; each panel shows one repair, with the means of the others thin behind it. "
        "Break-even is the first share at which the interval reaches 0.</p>\n");
    std::vector<Figure> figures;
    for (const FailureCurve& curve : study.failure_curves) {
        figures.push_back(panels(curve, &FailurePoint::travel_time, "failure-time",
                                 "EV travel time against the baseline, s"));
        figures.push_back(panels(curve, &FailurePoint::link_f1, "failure-links", "link F1"));
    }
    writer.figures(std::move(figures));
    writer.table({"break-even", "Break-even", break_even_table(study)});
}

}  // namespace clearway::report::detail
