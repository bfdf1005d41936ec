#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "report/detail/figures.hpp"
#include "report/published.hpp"
#include "report/sections/sections.hpp"
#include "report/verdict.hpp"

namespace clearway::report::detail {
namespace {

const char* delta_class(Effect effect) {
    if (effect == Effect::better) return "delta better";
    if (effect == Effect::worse) return "delta worse";
    return "delta";
}

std::string cell(const ScenarioFacts& scenario, const ConditionFacts& condition, const MeasureInfo& measure) {
    const MaybeEstimate& value = condition.value(measure.measure);
    const MaybeEstimate& difference = condition.difference(measure.measure);
    const int decimals = decimals_of(scenario, measure.measure);
    std::string html = fmt::format(
        "<td data-label=\"{}, {}\"><span class=\"mean\">{}</span>", measure.title, measure.unit,
        value ? number(value->mean * measure.printed_factor, typeset(decimals)) : missing(Script::typeset));
    if (const analysis::Interval* const interval = shown_interval(value))
        html += fmt::format("<span class=\"range\">{}</span>",
                            interval_text(*interval, typeset(decimals), measure.printed_factor));
    if (difference)
        html +=
            fmt::format("<span class=\"{}\">{}</span>", delta_class(effect_of(condition, measure.measure)),
                        estimate(difference, typeset(decimals, Sign::always), measure.printed_factor));
    if (is_void_for_lost(condition, measure.measure)) html += "<span class=\"delta worse\">lost EVs</span>";
    return html + "</td>";
}

std::string published_cell(const ScenarioFacts& scenario, const ConditionFacts& condition, Measure measure) {
    const auto value = published_value(scenario.published_as, condition.name(), measure);
    return fmt::format("<td class=\"published\" data-label=\"published\">{}</td>",
                       value ? number(*value, typeset(1)) : "");
}

/// Rows are conditions and columns are measures, with a column of published numbers after each measure that
/// has them.
std::string measure_table(const ScenarioFacts& scenario, std::span<const Measure> columns,
                          bool with_published) {
    std::string titles = "<tr class=\"group\"><th scope=\"col\">Condition</th>";
    std::string units = "<tr class=\"sub\"><th></th>";
    for (const Measure measure : columns) {
        titles += fmt::format("<th scope=\"col\" title=\"{}\"{}>{}</th>", info(measure).doc,
                              with_published ? " colspan=\"2\"" : "", info(measure).title);
        units += fmt::format("<th>{}</th>{}", info(measure).unit, with_published ? "<th>published</th>" : "");
    }
    std::string html = "<div class=\"scroll\" tabindex=\"0\"><table class=\"paired wider\"><thead>" + titles +
                       "</tr>" + units + "</tr></thead><tbody>\n";
    for (const ConditionFacts& condition : scenario.conditions) {
        html += fmt::format("<tr><th scope=\"row\">{}</th>", condition_label(condition));
        for (const Measure measure : columns) {
            html += cell(scenario, condition, info(measure));
            if (with_published) html += published_cell(scenario, condition, measure);
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

/// All statistics of the paired differences of a measure.
DataTable statistics_table(const ScenarioFacts& scenario, Measure measure) {
    DataTable table{
        {info(measure).title, "difference [95 %]", "BCa [95 %]", "median [95 %]", "effect size d_z", "p (t)",
         "p (Holm)", "p (Wilcoxon)", "pairs", "incomplete", "EVs left out"},
        {}};
    const NumberStyle style = typeset(decimals_of(scenario, measure), Sign::always);
    for (const ConditionFacts& condition : scenario.conditions) {
        const std::optional<analysis::Comparison>& paired = condition.outcome(measure).comparison;
        if (!paired) continue;
        const std::size_t pairs = paired->complete_pairs;
        MaybeEstimate bootstrap = paired->difference;
        if (bootstrap) bootstrap->interval = paired->bootstrap;
        const MaybeEstimate median =
            paired->median ? MaybeEstimate({pairs, *paired->median, 0.0, paired->median_interval})
                           : std::nullopt;
        table.rows.push_back(
            {condition.label(), estimate(paired->difference, style),
             shown_interval(bootstrap) != nullptr ? estimate(bootstrap, style) : missing(Script::typeset),
             estimate(median, style), number_or_dash(paired->effect_size, typeset(2)),
             p_words(paired->t_p, Script::typeset), p_words(paired->holm_p, Script::typeset),
             p_words(paired->wilcoxon_p, Script::typeset), grouped(pairs), grouped(paired->incomplete_pairs),
             grouped(paired->vehicles_left_out)});
    }
    return table;
}

/// The same as `measure_table`, as plain cells.
DataTable plain_table(const ScenarioFacts& scenario, std::span<const Measure> columns, bool with_published) {
    DataTable table{{"Condition"}, {}};
    for (const Measure measure : columns) {
        const std::string title = fmt::format("{}, {}", info(measure).title, info(measure).unit);
        table.head.push_back(title);
        table.head.push_back(title + ", difference");
        if (with_published) table.head.push_back(title + ", published");
    }
    for (const ConditionFacts& condition : scenario.conditions) {
        std::vector<std::string>& row = table.rows.emplace_back();
        row.push_back(condition.label());
        for (const Measure measure : columns) {
            const double factor = info(measure).printed_factor;
            const int decimals = decimals_of(scenario, measure);
            row.push_back(estimate(condition.value(measure), typeset(decimals), factor));
            row.push_back(estimate(condition.difference(measure), typeset(decimals, Sign::always), factor));
            const auto value = published_value(scenario.published_as, condition.name(), measure);
            if (with_published) row.push_back(value ? number(*value, typeset(1)) : "");
        }
    }
    return table;
}

/// But for rounding, as times are summed in another order.
bool is_equal(const MaybeEstimate& one, const MaybeEstimate& other) {
    constexpr double rounding_s = 1e-6;
    return one.has_value() == other.has_value() &&
           (!one || (one->n == other->n && std::abs(one->mean - other->mean) < rounding_s &&
                     std::abs(one->deviation - other->deviation) < rounding_s));
}

/// Whether a measure only repeats the primary one: travel times of EVs that arrived, where all did.
bool is_repeated(const ScenarioFacts& scenario, Measure measure) {
    return measure == Measure::emergency_travel_time &&
           std::ranges::all_of(scenario.conditions, [&](const ConditionFacts& condition) {
               return is_equal(condition.value(measure), condition.value(primary)) &&
                      is_equal(condition.difference(measure), condition.difference(primary));
           });
}

/// Those with a value under some condition, or without one because it lost EVs.
std::vector<Measure> used(const ScenarioFacts& scenario, std::span<const Measure> columns) {
    std::vector<Measure> measures;
    std::ranges::copy_if(columns, std::back_inserter(measures), [&](Measure measure) {
        return std::ranges::any_of(scenario.conditions, [&](const auto& one) {
            return one.value(measure) || is_void_for_lost(one, measure);
        });
    });
    return measures;
}

/// A table as readers see it, and its plain cells for downloads: a measure that repeats another is in CSV
/// alone, whose columns programs rely on. Without rows if no measure has a value.
Table measures_of(const ScenarioFacts& scenario, std::span<const Measure> wanted, const char* name,
                  const std::string& caption, bool with_published = false) {
    const std::vector<Measure> all = used(scenario, wanted);
    std::vector<Measure> columns = all;
    std::erase_if(columns, [&](Measure measure) { return is_repeated(scenario, measure); });
    if (columns.empty()) return {};
    return {fmt::format("{}-{}", name, scenario.name), caption,
            plain_table(scenario, columns, with_published), measure_table(scenario, columns, with_published),
            columns == all ? DataTable() : plain_table(scenario, all, with_published)};
}

/// `; p (Holm): of t, over 6 comparisons`: those whose runs differ. Empty where none does.
std::string holm_words(const ScenarioFacts& scenario, Measure measure) {
    std::size_t tested = 0;
    bool has_t = false;
    for (const ConditionFacts& condition : scenario.conditions) {
        const std::optional<analysis::Comparison>& paired = condition.outcome(measure).comparison;
        tested += paired && paired->holm_p ? 1 : 0;
        has_t = has_t || (paired && paired->t_p);
    }
    if (tested == 0) return "";
    return fmt::format("; p (Holm): of {}, over {}", has_t ? "t" : "Wilcoxon\u2019s test",
                       counted(tested, "comparison"));
}

void write_statistics(const ScenarioFacts& scenario, Writer& writer) {
    std::vector<Table> tables;
    for (const Measure measure : {Measure::emergency_restricted_time, Measure::emergency_travel_time,
                                  Measure::other_time_loss, Measure::collisions}) {
        if (is_repeated(scenario, measure)) continue;
        DataTable table = statistics_table(scenario, measure);
        if (!table.rows.empty())
            tables.push_back(
                {fmt::format("statistics-{}-{}", scenario.name, info(measure).field),
                 fmt::format("{}: {}, paired differences to the baseline, {}{}", scenario.name,
                             info(measure).title, info(measure).unit, holm_words(scenario, measure)),
                 std::move(table)});
    }
    if (tables.empty()) return;
    writer.open_fold("Statistics of the paired differences");
    for (Table& table : tables)
        writer.table(std::move(table));
    writer.markup(
        "<p class=\"note\">BCa: bootstrap interval of the mean. Effect size: mean of the differences "
        "over their standard deviation (Cohen\u2019s d for pairs, d<sub>z</sub>). p (Holm): adjusted "
        "over the rows that have one, of the t test, for counts of Wilcoxon\u2019s. Incomplete: replications "
        "without a value in both conditions; EVs left out: those that did not arrive in "
        "both.</p>");
    writer.close_fold();
}

void write_definitions(Writer& writer) {
    std::string html = "<dl class=\"facts\">\n";
    for (const MeasureInfo& measure : measures()) {
        html += fmt::format("<dt>{}, {}</dt><dd>{}</dd>\n", measure.title, measure.unit, measure.doc);
    }
    writer.open_fold("What the columns mean");
    writer.markup(html + "</dl>\n");
    writer.close_fold();
}

}  // namespace

void tables_section(const StudyFacts& study, Writer& writer) {
    constexpr std::array published_columns = {Measure::emergency_waiting_time,
                                              Measure::emergency_depart_delay, Measure::waiting_time};
    constexpr std::array emergency_columns = {Measure::emergency_restricted_time,
                                              Measure::emergency_travel_time, Measure::emergency_time_loss,
                                              Measure::gap_closed, Measure::other_time_loss};
    constexpr std::array event_columns = {Measure::depart_delay, Measure::collisions, Measure::teleports,
                                          Measure::unfinished};
    std::string html =
        "<p>Each cell: mean over the replications, its 95 % interval, and below them the paired difference "
        "to the baseline, coloured if its interval excludes 0 and the difference is large enough to count "
        "(blue: better, orange: worse).";
    if (std::ranges::any_of(study.scenarios, [](const auto& one) { return !one.published_as.empty(); }))
        html +=
            " The columns <em>published</em> repeat the dissertation: one unseeded run on networks of its "
            "own; they are not results of this study. The dissertation's single GraphSAGE row is repeated "
            "for two nets: as published and with corrected inputs.";
    html += "</p>\n";
    writer.markup(html);
    write_definitions(writer);
    for (const ScenarioFacts& scenario : study.scenarios) {
        const std::string caption = published_caption(scenario);
        writer.heading(scenario.name);
        if (const std::string uneven = uneven_runs_sentence(scenario); !uneven.empty())
            writer.markup(fmt::format("<p class=\"note\">{}</p>\n", escaped(uneven)));
        writer.table(measures_of(
            scenario, published_columns, "waiting",
            caption.empty()
                ? scenario.name + ": waiting time and depart delay, with differences to the baseline"
                : caption,
            !caption.empty()));
        writer.table(measures_of(scenario, emergency_columns, "times",
                                 scenario.name +
                                     ": travel time and time loss, with differences to the baseline" +
                                     (used(scenario, std::array{Measure::gap_closed}).empty()
                                          ? ""
                                          : "; intervals: t, of the gap closed: bootstrap (BCa)")));
        writer.table(
            measures_of(scenario, event_columns, "events-mean",
                        scenario.name + ": depart delay and events, with differences to the baseline"));
        write_statistics(scenario, writer);
    }
}

}  // namespace clearway::report::detail
