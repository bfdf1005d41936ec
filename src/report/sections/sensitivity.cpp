// Sensitivity: a tornado chart of every setting that was varied alone.

#include "report/sensitivity.hpp"

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr double label_left = 12.0;
constexpr double chart_left = 96.0;    // the values, shipped and turned to, are to the left of the drawing
constexpr double chart_right = 262.0;  // the numbers are to the right of the drawing
constexpr double level_height = 17.0;
constexpr double head_height = 20.0;
constexpr NumberStyle signed_tenths = typeset(1, Sign::ends_too);

using Rows = std::vector<const SensitivityRow*>;
using LevelDifference = MaybeEstimate SensitivityLevel::*;

void draw(Plot& plot, const SensitivityRow& row, const SensitivityLevel& level, LevelDifference member,
          double y) {
    const char* const mark = level.objection.empty() ? "" : " (!)";
    plot.text(label_left, y + 4.0, row.turned(level, "\u2192") + mark, Plot::Anchor::start, "label");
    plot.text(right_edge, y + 4.0, estimate(level.*member, signed_tenths), Plot::Anchor::end, "value");
    const MaybeEstimate& difference = level.*member;
    if (!difference) return;
    plot.beam({0.0, difference->mean}, y, {1});
    plot.estimate(difference, difference->interval ? &*difference->interval : nullptr, y, {1});
}

/// Of all rows, so that the charts above and below the fold have one scale.
Range range_of(const Sensitivity& sensitivity, LevelDifference member) {
    Range range;
    range.include(0.0);
    for (const SensitivityRow& row : sensitivity.rows) {
        for (const SensitivityLevel& level : row.levels)
            range.include_all(level.*member);
    }
    return padded(range, 0.06);
}

std::string tornado(const Sensitivity& sensitivity, const Rows& rows, LevelDifference member,
                    const std::string& label) {
    double height = 8.0 + label_space;
    for (const SensitivityRow* const row : rows)
        height += head_height + level_height * static_cast<double>(row->levels.size());
    Plot plot(fmt::format("{}, {}: {}", sensitivity.scenario, sensitivity.condition, label), height,
              {range_of(sensitivity, member), label, chart_left, chart_right},
              {{}, "", 4.0, height - label_space});
    plot.grid_x();
    plot.vertical(0.0);
    double top = 4.0;
    for (const SensitivityRow* const row : rows) {
        plot.blank(top, top + head_height);
        plot.text(2.0, top + 14.0, row->setting, Plot::Anchor::start, "heading");
        top += head_height;
        for (const SensitivityLevel& level : row->levels) {
            draw(plot, *row, level, member, top + level_height / 2.0);
            top += level_height;
        }
    }
    return plot.finish();
}

DataTable data_of(const Rows& rows) {
    DataTable table{{"Setting", "shipped", "turned to", labelled(primary, "difference") + " [95 %]",
                     labelled(Measure::other_time_loss, "difference") + " [95 %]", "pairs", "objection"},
                    {}};
    for (const SensitivityRow* const row : rows) {
        for (const SensitivityLevel& level : row->levels)
            table.rows.push_back(
                {row->setting, row->shipped.empty() ? missing(Script::typeset) : row->shipped, level.value,
                 estimate(level.emergency, signed_tenths), estimate(level.others, signed_tenths),
                 level.emergency ? grouped(level.emergency->n) : missing(Script::typeset), level.objection});
    }
    return table;
}

void write_figures(const Sensitivity& sensitivity, const Rows& rows, Writer& writer) {
    const std::string of = fmt::format("{}-{}", sensitivity.scenario, sensitivity.condition);
    writer.figures(
        {{"sensitivity-emergency-" + of, "Emergency vehicles",
          tornado(sensitivity, rows, &SensitivityLevel::emergency, labelled(primary, "difference")), "",
          data_of(rows)},
         {"sensitivity-others-" + of, "The others",
          tornado(sensitivity, rows, &SensitivityLevel::others,
                  labelled(Measure::other_time_loss, "difference")),
          "", data_of(rows)}});
}

void write_chart(const Sensitivity& sensitivity, Writer& writer) {
    Rows shown;
    Rows folded;
    for (const SensitivityRow& row : sensitivity.rows)
        (row.shows_nothing() ? folded : shown).push_back(&row);
    writer.heading(fmt::format("{}, {}", sensitivity.scenario, sensitivity.condition));
    if (shown.empty()) writer.markup("<p>No setting has a shown effect.</p>\n");
    if (!shown.empty()) write_figures(sensitivity, shown, writer);
    if (folded.empty()) return;
    writer.open_fold(fmt::format("{} without a shown effect: both intervals include 0 at every level",
                                 counted(folded.size(), "setting")));
    write_figures(sensitivity, folded, writer);
    writer.close_fold();
}

}  // namespace

void sensitivity_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>Each setting of a condition varied alone, from its shipped value to another one (shipped \u2192 "
        "turned to), compared with the same condition at its defaults: paired differences with 95 % "
        "intervals. Below 0 is a gain. The setting with the largest effect on emergency vehicles comes "
        "first. (!): against the baseline, the level loses or hits more emergency vehicles or ran without "
        "safety checks. With many settings, one interval in twenty excludes 0 by chance.</p>\n");
    for (const Sensitivity& sensitivity : study.sensitivities)
        write_chart(sensitivity, writer);
}

}  // namespace clearway::report::detail
