// Sensitivity: a tornado chart of every setting that was varied alone.

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/markup.hpp"
#include "report/detail/sections.hpp"
#include "report/sensitivity.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr double chart_left = 26.0;
constexpr double chart_right = 262.0;  // the numbers are to the right of the drawing
constexpr double level_height = 17.0;
constexpr double heading_height = 20.0;
constexpr NumberStyle signed_tenths{.decimals = 1, .script = Script::typeset, .sign = Sign::always};

using Member = std::optional<analysis::Estimate> SensitivityLevel::*;

void include(const std::optional<analysis::Estimate>& estimate, Range& range) {
    if (!estimate) return;
    range.include(estimate->mean);
    if (!estimate->interval) return;
    range.include(estimate->interval->low);
    range.include(estimate->interval->high);
}

void draw(Plot& plot, const SensitivityLevel& level, Member member, double y) {
    plot.text(chart_left, y + 4.0, level.value, Plot::Anchor::start, "label");
    plot.text(right_edge, y + 4.0, estimate(level.*member, signed_tenths), Plot::Anchor::end, "value");
    const std::optional<analysis::Estimate>& estimate = level.*member;
    if (!estimate) return;
    plot.beam({0.0, estimate->mean}, y, 1);
    if (estimate->interval) {
        plot.interval({estimate->interval->low, estimate->interval->high}, estimate->mean, y, 1);
    } else {
        plot.point(estimate->mean, y, 1);
    }
}

std::string tornado(const Sensitivity& sensitivity, Member member, const std::string& label) {
    Range range;
    range.include(0.0);
    double height = 8.0;
    for (const SensitivityRow& row : sensitivity.rows) {
        height += heading_height + level_height * static_cast<double>(row.levels.size());
        for (const SensitivityLevel& level : row.levels)
            include(level.*member, range);
    }
    height += label_space;
    Plot plot(fmt::format("{}, {}: {}", sensitivity.scenario, sensitivity.condition, label), height,
              {padded(range, 0.06), label, chart_left + 46.0, chart_right},
              {{}, "", 4.0, height - label_space});
    plot.grid_x();
    plot.vertical(0.0);
    double top = 4.0;
    for (const SensitivityRow& row : sensitivity.rows) {
        plot.text(chart_left - 16.0, top + 13.0, row.setting, Plot::Anchor::start, "heading");
        top += heading_height;
        for (const SensitivityLevel& level : row.levels) {
            draw(plot, level, member, top + level_height / 2.0);
            top += level_height;
        }
    }
    return plot.finish();
}

DataTable data_of(const Sensitivity& sensitivity) {
    DataTable table{
        {"Setting", "value", "EV travel time, s [95 %]", "others\u2019 time loss, s [95 %]", "pairs"}, {}};
    for (const SensitivityRow& row : sensitivity.rows) {
        for (const SensitivityLevel& level : row.levels)
            table.rows.push_back({row.setting, level.value, estimate(level.emergency, signed_tenths),
                                  estimate(level.others, signed_tenths),
                                  level.emergency ? grouped(level.emergency->n) : missing(Script::typeset)});
    }
    return table;
}

}  // namespace

std::string sensitivity_section(const StudyFacts& study) {
    std::string html =
        "<p>Each setting of a condition varied alone, compared with the same condition at its defaults: "
        "paired differences with 95 % intervals. Below 0 is a gain. The setting with the largest effect on "
        "emergency vehicles comes first.</p>\n"
        "<div class=\"figures\">\n";
    for (const Sensitivity& sensitivity : study.sensitivities) {
        const std::string caption = fmt::format("{}, {}", sensitivity.scenario, sensitivity.condition);
        html += to_html(
            Figure{caption + ": emergency vehicles",
                   tornado(sensitivity, &SensitivityLevel::emergency, "EV travel time, difference, s"), "",
                   "", data_of(sensitivity)});
        html += to_html(
            Figure{caption + ": the others",
                   tornado(sensitivity, &SensitivityLevel::others, "time loss of the others, difference, s"),
                   "", "", data_of(sensitivity)});
    }
    return html + "</div>\n";
}

}  // namespace clearway::report::detail
