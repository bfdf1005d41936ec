#include "report/console.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "report/published.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

constexpr std::size_t page_width = 110;
constexpr std::size_t label_width = 38;

/// Names come from files: nothing in them may steer the terminal. For text of several lines.
std::string safe_table(std::string text) {
    std::ranges::replace_if(
        text,
        [](char letter) {
            const auto code = static_cast<unsigned char>(letter);
            return (code < 0x20 && letter != '\n') || code == 0x7f;
        },
        '?');
    return text;
}

std::string label(const ConditionFacts& condition) {
    return printable(condition.label());
}

std::string published_text(const ScenarioFacts& scenario, const ConditionFacts& condition, Measure measure) {
    const auto value = published_value(scenario.name, condition.name, measure);
    return value ? number(*value, {.decimals = 1}) : std::string();
}

/// `8.1 +- 0.9`: the mean and half the width of its interval.
std::string mean_and_half_width(const Estimate& value, NumberStyle style) {
    if (!value.mean) return missing(style.script);
    std::string text = number(*value.mean, style);
    if (value.has_interval()) text += fmt::format(" +- {}", number((*value.high - *value.low) / 2.0, style));
    return text;
}

void append_published_table(const ScenarioFacts& scenario, std::string& text) {
    auto out = std::back_inserter(text);
    constexpr std::array columns = {Measure::emergency_waiting_time, Measure::emergency_depart_delay,
                                    Measure::waiting_time};
    fmt::format_to(out, "{:<{}}", "", label_width);
    for (const Measure measure : columns) {
        fmt::format_to(out, "{:>24}", info(measure).title);
    }
    fmt::format_to(out, "\n{:<{}}", "Condition", label_width);
    for (std::size_t column = 0; column < columns.size(); ++column) {
        fmt::format_to(out, "{:>14}{:>10}", "here, s", "published");
    }
    fmt::format_to(out, "\n{:-<{}}\n", "", page_width);
    for (const ConditionFacts& condition : scenario.conditions) {
        fmt::format_to(out, "{:<{}}", label(condition), label_width);
        for (const Measure measure : columns) {
            const NumberStyle style{.decimals = decimals_of(scenario, measure)};
            fmt::format_to(out, "{:>14}{:>10}", mean_and_half_width(condition.outcome(measure).value, style),
                           published_text(scenario, condition, measure));
        }
        text += '\n';
    }
}

/// Mean right-aligned, then the interval.
std::string split_cell(const Estimate& value, NumberStyle style, double factor) {
    if (!value.mean) return fmt::format("{:>9}  {:<17}", missing(style.script), "");
    const std::string whole = estimate(value, style, factor);
    const std::size_t space = whole.find(' ');
    return fmt::format("{:>9}  {:<17}", whole.substr(0, space),
                       space == std::string::npos ? "(no interval)" : whole.substr(space + 1));
}

const char* effect_word(Effect effect) {
    switch (effect) {
        case Effect::better:
            return "better";
        case Effect::worse:
            return "worse";
        case Effect::negligible:
            return "not relevant";
        case Effect::none_shown:
            return "no effect shown";
        case Effect::undecided:
            break;
    }
    return "";
}

void append_measure(const ScenarioFacts& scenario, const MeasureInfo& measure, std::string& text) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "\n{}, {}\n", measure.title, measure.unit);
    const int decimals = decimals_of(scenario, measure.measure);
    for (const ConditionFacts& condition : scenario.conditions) {
        const Outcome& outcome = condition.outcome(measure.measure);
        std::string line = fmt::format("  {:<{}}", label(condition), label_width - 2);
        line += split_cell(outcome.value, {.decimals = decimals}, measure.printed_factor);
        if (condition.is_compared()) {
            line += split_cell(outcome.difference, {.decimals = decimals, .sign = Sign::always},
                               measure.printed_factor);
            line += effect_word(effect_of(outcome, measure.better));
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    }
}

/// Breaks at spaces; lines after the first are indented.
void append_wrapped(const std::string& paragraph, std::string& text) {
    std::size_t start = 0;
    const std::string indent = "    ";
    bool first = true;
    while (start < paragraph.size()) {
        const std::size_t room = page_width - (first ? 0 : indent.size());
        std::size_t end = paragraph.size();
        if (end - start > room) {
            end = paragraph.rfind(' ', start + room);
            if (end == std::string::npos || end <= start) end = start + room;
        }
        text += (first ? "" : indent) + paragraph.substr(start, end - start) + '\n';
        start = end + (end < paragraph.size() && paragraph[end] == ' ' ? 1 : 0);
        first = false;
    }
}

void append_runs(const ScenarioFacts& scenario, std::string& text) {
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.failed.empty()) continue;
        append_wrapped(
            fmt::format("Failed: {}: {} of {}; first: replication {}: {}", label(condition),
                        counted(condition.failed.size(), "run"), condition.failed.size() + condition.runs,
                        condition.failed.front().replication, printable(condition.failed.front().cause)),
            text);
    }
}

/// Median and 95th percentile over all EVs, those that did not arrive ranked last.
void append_tails(const ScenarioFacts& scenario, std::string& text) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "\n{:<{}}{:>9}  {:<17}{:>9}  {}\n{:-<{}}\n", "EV travel time over all EVs, s",
                   label_width, "median", "95 % interval", "95th perc.", "95 % interval", "", page_width);
    for (const ConditionFacts& condition : scenario.conditions) {
        std::string line = fmt::format("  {:<{}}", label(condition), label_width - 2);
        line += split_cell(condition.travel_time_median, {}, 1.0);
        line += split_cell(condition.travel_time_percentile_95, {}, 1.0);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    }
}

/// Pairs and vehicles that the differences of EV travel time leave out.
void append_censored(const ScenarioFacts& scenario, std::string& text) {
    for (const ConditionFacts& condition : scenario.conditions) {
        const auto& paired = condition.outcome(Measure::emergency_travel_time).paired;
        if (!paired || (paired->incomplete_pairs == 0 && paired->vehicles_left_out == 0)) continue;
        append_wrapped(
            fmt::format(
                "Left out of differences of EV travel time: {}: {} of {} without an EV that arrived in "
                "both conditions, and {} in the others that did not.",
                label(condition), counted(paired->incomplete_pairs, "pair"),
                paired->incomplete_pairs + paired->complete_pairs, counted(paired->vehicles_left_out, "EV")),
            text);
    }
}

void append_scenario(const ScenarioFacts& scenario, std::string& text) {
    auto out = std::back_inserter(text);
    const auto table = published_table(scenario.name);
    fmt::format_to(out, "{:=<{}}\n{}: {}\n", "", page_width, printable(scenario.name),
                   counted(scenario.replications, "replication"));
    if (table) {
        fmt::format_to(out, "\n{}\n", table->caption);
        append_published_table(scenario, text);
    }
    fmt::format_to(out, "\n{:<{}}{:>9}  {:<17}{:>9}  {:<17}{}\n{:-<{}}\n", "Measure and condition",
                   label_width, "mean", "95 % interval", "diff.", "95 % interval", "effect", "", page_width);
    for (const MeasureInfo& measure : measures()) {
        append_measure(scenario, measure, text);
    }
    append_tails(scenario, text);
    text += '\n';
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.is_compared()) continue;
        append_wrapped(
            fmt::format("{}: {}", label(condition), printable(verdict(scenario, condition, Script::plain))),
            text);
    }
    append_censored(scenario, text);
    append_runs(scenario, text);
    const std::string wide = wide_edges_sentence(scenario);
    if (!wide.empty()) append_wrapped(wide, text);
    text += '\n';
}

}  // namespace

std::string console_tables(const StudyFacts& study) {
    std::string text;
    bool any_unsafe = false;
    for (const ScenarioFacts& scenario : study.scenarios) {
        append_scenario(scenario, text);
        any_unsafe =
            any_unsafe || std::any_of(scenario.conditions.begin(), scenario.conditions.end(),
                                      [](const ConditionFacts& one) { return one.safety_checks_off; });
    }
    text += safe_table(failure_table(study.failure_curves));
    text += safe_table(sensitivity_table(study.sensitivities));
    append_wrapped(
        "here: mean and half width of its 95 % interval. diff.: mean of the paired differences to the "
        "baseline of the "
        "same replication; better or worse when its interval excludes 0; not relevant where an EV's time "
        "changes by less than what counts ("
        "--least-difference). published: the dissertation's "
        "number, one "
        "unseeded run on a network of its own; not a result of this study.",
        text);
    if (any_unsafe) append_wrapped("(!): the simulator's safety checks were off in this condition.", text);
    return text;
}

}  // namespace clearway::report
