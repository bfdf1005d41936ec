// Benefit against failure: what is left of a policy's benefit when vehicles go dark, and the believed links
// behind it.

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/failure_curve.hpp"
#include "report/sections/sections.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr double percent = 100.0;
using Member = MaybeEstimate FailurePoint::*;

DataTable data_of(const FailureCurve& curve) {
    DataTable table{{"Repair", "dark, %", labelled(primary, "difference"), "pairs", "link F1"}, {}};
    for (const FailureLine& line : curve.lines) {
        for (const FailurePoint& point : line.points) {
            table.rows.push_back(
                {line.repair, number(percent * point.dark_share, typeset(0)),
                 estimate(point.travel_time, typeset(2, Sign::ends_too)),
                 point.travel_time ? grouped(point.travel_time->n) : missing(Script::typeset),
                 estimate(point.link_f1, typeset(3))});
        }
    }
    return table;
}

Points means_of(const FailureLine& line, Member member) {
    Points means;
    for (const FailurePoint& point : line.points) {
        if (point.*member) means.emplace_back(percent * point.dark_share, (point.*member)->mean);
    }
    return means;
}

void draw_panel(Plot& plot, const FailureCurve& curve, const FailureLine& own, Member member) {
    if (member == &FailurePoint::travel_time) plot.horizontal(0.0);
    plot.text(plot.x().from, plot.y().to - 6.0, shortened(own.repair, 22), Plot::Anchor::start, "heading");
    for (const FailureLine& line : curve.lines)
        plot.hair(means_of(line, member), {0});
    for (const FailurePoint& point : own.points) {
        if (!(point.*member) || !(point.*member)->interval) continue;
        const analysis::Interval& interval = *(point.*member)->interval;
        plot.whisker(percent * point.dark_share, {interval.low, interval.high}, {1});
    }
    plot.line(means_of(own, member), {1, Series::Weight::lead});
}

/// One estimate over the share of time dark: a panel for each repair, with the others thin behind it. All
/// have one scale.
Figure curve_figure(const FailureCurve& curve, Member member, const char* name, const std::string& label) {
    Range shares;
    Range values;
    if (member == &FailurePoint::travel_time) values.include(0.0);
    for (const FailureLine& line : curve.lines) {
        for (const FailurePoint& point : line.points) {
            shares.include(percent * point.dark_share);
            values.include_all(point.*member);
        }
    }
    if (values.empty()) return {};
    const std::string title = fmt::format("{}, policy {}: {}", curve.scenario, curve.policy, label);
    return {
        fmt::format("{}-{}-{}", name, curve.scenario, curve.policy), title,
        panels({title, label, "time dark, %"}, curve.lines.size(), {padded(shares, 0.08), ""},
               {padded(values, 0.06), ""},
               [&](Plot& plot, std::size_t panel) { draw_panel(plot, curve, curve.lines[panel], member); }),
        curve.failure.empty() ? "" : "Failure: " + curve.failure + ".", data_of(curve)};
}

DataTable break_even_table(const StudyFacts& study) {
    DataTable table{{"Scenario, policy, repair", "benefit shown up to", "not shown from", "link F1 there"},
                    {}};
    const auto dark = [](const FailurePoint& point) {
        return number(percent * point.dark_share, typeset(0)) + " %";
    };
    for (const FailureCurve& curve : study.failure_curves) {
        for (const FailureLine& line : curve.lines) {
            const std::size_t first = line.break_even.value_or(line.points.size());
            const std::string name = fmt::format("{}, {}, {}", curve.scenario, curve.policy, line.repair);
            const bool ends = line.break_even.has_value();
            table.rows.push_back(
                {name, first == 0 ? missing(Script::typeset) : dark(line.points[first - 1]),
                 ends ? dark(line.points[first]) : missing(Script::typeset),
                 ends ? estimate(line.points[first].link_f1, typeset(3)) : missing(Script::typeset)});
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
        figures.push_back(
            curve_figure(curve, &FailurePoint::travel_time, "failure-time", labelled(primary, "difference")));
        figures.push_back(curve_figure(curve, &FailurePoint::link_f1, "failure-links", "link F1, 0 to 1"));
    }
    writer.figures(std::move(figures));
    writer.table({"break-even", "Break-even", break_even_table(study)});
}

}  // namespace clearway::report::detail
