// Benefit against failure: what is left of a policy's benefit when vehicles go dark, and the believed links
// behind it.

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/markup.hpp"
#include "report/detail/sections.hpp"
#include "report/failure_curve.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr double left_edge = 52.0;
constexpr double right_edge = 388.0;
constexpr double height = 250.0;
constexpr double label_space = 44.0;
constexpr double percent = 100.0;
/// Shift between neighbouring lines, percent, so that no bar hides another.
constexpr double line_offset = 1.2;

using Member = std::optional<analysis::Estimate> FailurePoint::*;

void include(const analysis::Estimate& estimate, Range& range) {
    range.include(estimate.mean);
    if (!estimate.interval) return;
    range.include(estimate.interval->low);
    range.include(estimate.interval->high);
}

/// One estimate over the share of time dark, with one line per repair.
std::string drawing(const FailureCurve& curve, Member member, const std::string& label) {
    Range shares;
    Range values;
    if (member == &FailurePoint::travel_time) values.include(0.0);
    for (const FailureLine& line : curve.lines) {
        for (const FailurePoint& point : line.points) {
            const double reach = line_offset * static_cast<double>(curve.lines.size()) / 2.0;
            shares.include(percent * point.dark_share - reach);
            shares.include(percent * point.dark_share + reach);
            if (point.*member) include(*(point.*member), values);
        }
    }
    if (values.empty()) return {};
    Plot plot(fmt::format("{}, policy {}: {}", curve.scenario, curve.policy, label), height,
              {padded(shares, 0.04), "share of time dark, %", left_edge, right_edge},
              {padded(values, 0.06), label, height - label_space, 26.0});
    plot.grid_x();
    plot.grid_y();
    if (member == &FailurePoint::travel_time) plot.horizontal(0.0);
    for (std::size_t series = 0; series < curve.lines.size(); ++series) {
        const double offset = line_offset * (static_cast<double>(series) -
                                             (static_cast<double>(curve.lines.size()) - 1.0) / 2.0);
        std::vector<std::pair<double, double>> means;
        for (const FailurePoint& point : curve.lines[series].points) {
            if (!(point.*member)) continue;
            const analysis::Estimate& estimate = *(point.*member);
            const double at = percent * point.dark_share + offset;
            means.emplace_back(at, estimate.mean);
            if (estimate.interval)
                plot.whisker(at, {estimate.interval->low, estimate.interval->high}, series);
        }
        plot.line(means, series);
    }
    return plot.finish();
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

std::string figure_of(const FailureCurve& curve) {
    std::vector<std::pair<std::size_t, std::string>> entries;
    for (std::size_t series = 0; series < curve.lines.size(); ++series) {
        entries.emplace_back(series, curve.lines[series].repair);
    }
    const std::string drawings =
        drawing(curve, &FailurePoint::travel_time, "EV travel time, difference to the baseline, s") +
        drawing(curve, &FailurePoint::link_f1, "link F1");
    return to_html(Figure{fmt::format("{}, policy {}", curve.scenario, curve.policy), drawings,
                          legend(entries), curve.failure.empty() ? "" : "Failure: " + curve.failure + ".",
                          data_of(curve)});
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

std::string failure_section(const StudyFacts& study) {
    std::string html =
        "<p>What is left of a policy\u2019s benefit when vehicles are dark for a share of the time, and how "
        "accurate the believed links were meanwhile (F1 end to end: links of vehicles never seen count as "
        "missed). Below 0, EVs are faster than without the policy. The bars are 95 % intervals of the "
        "paired differences; the lines are shifted a little so that none hides another. Break-even is the "
        "first share at which the interval reaches 0.</p>\n"
        "<div class=\"figures\">\n";
    for (const FailureCurve& curve : study.failure_curves) {
        html += figure_of(curve);
    }
    return html + "</div>\n<h3>Break-even</h3>\n" + to_html(break_even_table(study));
}

}  // namespace clearway::report::detail
