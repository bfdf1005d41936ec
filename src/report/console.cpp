#include "report/console.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

#include "report/lease_words.hpp"
#include "report/overview.hpp"
#include "report/planned_text.hpp"
#include "report/published.hpp"
#include "report/shared_sentences.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

constexpr std::size_t page_width = 80;
constexpr std::size_t label_width = 22;

/// Replaces control characters other than newlines, because names come from files and must not control the
/// terminal.
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

void append_row(const ConditionFacts& condition, const std::string& cells, std::string& text) {
    text += table_row("  " + label(condition), label_width, cells);
}

std::string published_text(const ScenarioFacts& scenario, const ConditionFacts& condition, Measure measure) {
    const auto value = published_value(scenario.published_as, condition.name(), measure);
    return value ? number(*value, {.decimals = 1}) : std::string();
}

/// `8.1 +- 0.9`: the mean and half the width of its interval; `0.4 (<2.1)` if the bound at 0 makes it
/// asymmetric.
std::string mean_and_half_width(const MaybeEstimate& value, NumberStyle style) {
    if (!value) return missing(style.script);
    const std::string text = number(value->mean, style);
    const analysis::Interval* const interval = shown_interval(value);
    if (interval == nullptr) return text;
    const bool is_lopsided = interval->high - value->mean > 1.001 * (value->mean - interval->low) + 1e-9;
    return text + (is_lopsided ? fmt::format(" (<{})", number(interval->high, style))
                               : fmt::format(" +- {}", number(interval->half_width(), style)));
}

/// Fits a column of TABLES II to IV.
const char* short_title(Measure measure) {
    switch (measure) {
        case Measure::emergency_waiting_time:
            return "EV waiting";
        case Measure::emergency_depart_delay:
            return "EV depart delay";
        default:
            return "average waiting";
    }
}

void append_published_table(const ScenarioFacts& scenario, std::string& text) {
    auto out = std::back_inserter(text);
    constexpr std::array columns = {Measure::emergency_waiting_time, Measure::emergency_depart_delay,
                                    Measure::waiting_time};
    constexpr int here_width = 13;
    constexpr int published_width = 6;
    fmt::format_to(out, "{:<{}}", "Condition", label_width);
    for (const Measure measure : columns)
        fmt::format_to(out, "{:>{}}", short_title(measure), here_width + published_width);
    fmt::format_to(out, "\n{:<{}}", "", label_width);
    for (std::size_t column = 0; column < columns.size(); ++column)
        fmt::format_to(out, "{:>{}}{:>{}}", "here, s", here_width - 4, "published", published_width + 4);
    fmt::format_to(out, "\n{:-<{}}\n", "", page_width);
    for (const ConditionFacts& condition : scenario.conditions) {
        std::string line;
        for (const Measure measure : columns) {
            const NumberStyle style{.decimals = decimals_of(scenario, measure)};
            line += fmt::format("{:>{}}{:>{}}", mean_and_half_width(condition.value(measure), style),
                                here_width, published_text(scenario, condition, measure), published_width);
        }
        append_row(condition, line, text);
    }
}

/// Mean right-aligned, then the interval.
std::string split_cell(const MaybeEstimate& value, NumberStyle style, double factor = 1.0) {
    const analysis::Interval* const interval = shown_interval(value);
    return fmt::format("{:>7}  {:<14} ", value ? number(value->mean * factor, style) : missing(style.script),
                       !value                                     ? ""
                       : interval != nullptr                      ? interval_text(*interval, style, factor)
                       : value->n < analysis::fewest_for_interval ? "too few seeds"
                                                                  : "(no interval)");
}

bool is_about_emergency(const MeasureInfo& measure) {
    return measure.relevance == Relevance::least || measure.measure == Measure::gap_closed;
}

std::string effect_word(const ConditionFacts& condition, Measure measure) {
    const Effect effect = effect_of(condition, measure);
    if (effect == Effect::too_few || effect == Effect::undecided) return "";
    if (effect == Effect::none_shown) return "none shown";
    if (effect != Effect::ruled_out) return std::string(core::name(effect));
    if (is_about_emergency(info(measure)) || condition.objections.unchecked)
        return analysis::emergency_objection_word(condition.objections);
    return "others lost";
}

std::string response_word(const MaybeEstimate& difference, Better better) {
    // Percentiles vary more than the mean; where there is no interval, the cell before says it.
    if (difference && difference->n < fewest_to_trust)
        return difference->n < analysis::fewest_for_interval ? "" : "few seeds";
    const Effect effect = effect_of(difference, better);
    if (effect == Effect::too_few || effect == Effect::undecided) return "";
    return effect == Effect::none_shown ? "none shown" : std::string(core::name(effect));
}

std::string measure_rows(const ScenarioFacts& scenario, const MeasureInfo& measure) {
    std::string text;
    const int decimals = decimals_of(scenario, measure.measure);
    for (const ConditionFacts& condition : scenario.conditions) {
        std::string line =
            split_cell(condition.value(measure.measure), {.decimals = decimals}, measure.printed_factor);
        if (is_void_for_lost(condition, measure.measure)) {
            line += std::string(split_cell({}, {}).size(), ' ') + "lost EVs";
        } else if (condition.is_compared()) {
            line += split_cell(condition.difference(measure.measure),
                               {.decimals = decimals, .sign = Sign::always}, measure.printed_factor) +
                    effect_word(condition, measure.measure);
        }
        append_row(condition, line, text);
    }
    return text;
}

void append_measure(const ScenarioFacts& scenario, const MeasureInfo& measure, std::string& text) {
    if (std::ranges::none_of(scenario.conditions, [&](const ConditionFacts& condition) {
            return condition.value(measure.measure) || condition.difference(measure.measure) ||
                   is_void_for_lost(condition, measure.measure);
        }))
        return;  // dashes alone
    const std::string rows = measure_rows(scenario, measure);
    const bool is_told = measure.measure == Measure::emergency_travel_time &&
                         rows == measure_rows(scenario, info(Measure::emergency_restricted_time));
    text += fmt::format("\n{}, {}{}\n", measure.title, measure.unit, is_told ? ": the same as of all" : "");
    if (!is_told) text += rows;
}

/// Wraps at spaces; lines after the first are indented.
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

/// Of what kind they are; their messages are told on standard error.
void append_failed(const ScenarioFacts& scenario, std::string& text) {
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.failed.empty()) continue;
        const FailedRun& first = condition.failed.front();
        append_wrapped(fmt::format("Failed: {}: {} of {}; first: replication {}, {}", label(condition),
                                   counted(condition.failed.size(), "run"),
                                   condition.failed.size() + condition.complete_runs, first.replication,
                                   printable(first.cause.substr(0, first.cause.find(':')))),
                       text);
    }
}

/// Median and 95th percentile over all EVs. Those that did not arrive rank last.
void append_tails(const ScenarioFacts& scenario, std::string& text) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "\nEV travel time over all EVs, s\n{:<{}}{:>7}  {:<14}{:>8}  {}\n{:-<{}}\n", "",
                   label_width, "median", "95 % interval", "95th pc.", "95 % interval", "", page_width);
    for (const ConditionFacts& condition : scenario.conditions) {
        append_row(condition,
                   split_cell(condition.travel_time.median, {}) +
                       split_cell(condition.travel_time.percentile_95, {}),
                   text);
    }
}

using Trips = MaybeEstimate analysis::ResponseTime::*;

struct TripRows {
    std::string title;
    Trips value;
    Trips difference;
    double factor = 1.0;
};

void append_trips(const ScenarioFacts& scenario, const TripRows& rows, std::string& text) {
    if (std::ranges::none_of(scenario.conditions, [&](const ConditionFacts& condition) {
            return condition.response.*rows.value || condition.response.*rows.difference;
        }))
        return;
    text += fmt::format("\n{}\n", rows.title);
    for (const ConditionFacts& condition : scenario.conditions) {
        const analysis::ResponseTime& response = condition.response;
        std::string line = split_cell(response.*rows.value, {}, rows.factor);
        if (condition.is_compared())
            line +=
                split_cell(response.*rows.difference, {.sign = Sign::always}, rows.factor) +
                response_word(response.*rows.difference, rows.factor > 1.0 ? Better::higher : Better::lower);
        append_row(condition, line, text);
    }
}

/// How many EVs are in time, and how late the slow ones are.
void append_response(const ScenarioFacts& scenario, Tables tables, std::string& text) {
    using Response = analysis::ResponseTime;
    if (scenario.response_threshold_s <= 0.0) return;
    constexpr double percent = 100.0;
    if (tables == Tables::all)
        append_trips(scenario,
                     {"EV response time, 90th percentile, s", &Response::percentile_90_s,
                      &Response::percentile_90_difference_s},
                     text);
    append_trips(scenario,
                 {fmt::format("EV trips within {:g} s (100 s per km of the mean EV route unless given), %",
                              scenario.response_threshold_s),
                  &Response::in_time, &Response::in_time_difference, percent},
                 text);
}

/// How signals served EVs, a line for each condition that asked them.
void append_signals(const ScenarioFacts& scenario, std::string& text) {
    constexpr std::array columns = {std::pair{"signal_calls", "calls"},
                                    std::pair{"signal_calls_granted", "granted"},
                                    std::pair{"held_greens_useless", "useless"},
                                    std::pair{"signal_entry_delay_s", "entry s"},
                                    std::pair{"signal_time_to_service_s", "green s"},
                                    std::pair{"signal_dwell_s", "hold s"},
                                    std::pair{"signal_recovery_s", "back s"}};
    constexpr int width = 8;
    std::string rows;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.complete_runs == 0 || condition.total("signal_calls") == 0.0) continue;
        std::string line;
        for (const auto& [metric, title] : columns)
            line +=
                fmt::format("{:>{}}", number_or_dash(mean_of(condition.metric(metric).estimate), {}), width);
        append_row(condition, line, rows);
    }
    if (rows.empty()) return;
    text += fmt::format("\n{:<{}}", "Signals, mean of runs", label_width);
    for (const auto& [metric, title] : columns)
        text += fmt::format("{:>{}}", title, width);
    text += fmt::format("\n{:-<{}}\n{}", "", page_width, rows);
}

/// Pairs and vehicles that the differences of EV travel time leave out.
void append_censored(const ScenarioFacts& scenario, std::string& text) {
    for (const ConditionFacts& condition : scenario.conditions) {
        const auto& paired = condition.outcome(Measure::emergency_travel_time).comparison;  // arrived only
        if (!paired || (paired->incomplete_pairs == 0 && paired->vehicles_left_out == 0)) continue;
        append_wrapped(fmt::format("Left out of the differences of EV travel time, arrived only: {}: {} of "
                                   "{} in which no EV arrived in both conditions, and {} in the other pairs.",
                                   label(condition), counted(paired->incomplete_pairs, "pair"),
                                   paired->incomplete_pairs + paired->complete_pairs,
                                   counted(paired->vehicles_left_out, "EV")),
                       text);
    }
}

std::uint64_t emergency_vehicles(const ScenarioFacts& scenario) {
    std::uint64_t most = 0;
    for (const ConditionFacts& condition : scenario.conditions)
        most = std::max(most, condition.emergency.total());
    return most;
}

/// What the policies asked for, because it often explains a null result.
void append_leases(const ScenarioFacts& scenario, std::string& text) {
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.condition.policies.empty() || condition.complete_runs == 0) continue;
        append_wrapped(
            fmt::format("Actions: {}: {}.", label(condition), printable(lease_sentence(condition))), text);
    }
}

void append_head(const ScenarioFacts& scenario, std::string& text) {
    const std::uint64_t emergency = emergency_vehicles(scenario);
    std::uint64_t complete = 0;
    for (const ConditionFacts& condition : scenario.conditions)
        complete = std::max<std::uint64_t>(complete, condition.complete_runs);
    fmt::format_to(
        std::back_inserter(text), "{:=<{}}\n{}{}: {}{}, {} (EV) per condition\n", "", page_width,
        printable(scenario.name), scenario.variant.empty() ? "" : ", " + printable(scenario.variant),
        counted(scenario.replications, "replication"),
        complete < scenario.replications ? fmt::format(" planned, {} complete at most", complete) : "",
        counted(emergency, "emergency vehicle"));
    append_wrapped(scenario.assumptions, text);
    append_wrapped(printable(kept_requests_sentence(scenario)), text);
    append_wrapped(printable(unsent_messages_sentence(scenario)), text);
    const bool has_runs = std::ranges::any_of(
        scenario.conditions, [](const auto& condition) { return condition.complete_runs > 0; });
    if (emergency == 0 && has_runs)
        append_wrapped(
            "The demand has no emergency vehicle (emergency = 0): rows about EVs are left out, and there is "
            "nothing to judge a policy by. Set emergency to 1 or more.",
            text);
}

bool is_essential(Measure measure) {
    return measure == Measure::emergency_restricted_time || measure == Measure::other_time_loss;
}

/// The scenario without the conditions that have one setting turned alone: the table of sensitivities shows
/// them, unless they stand out.
ScenarioFacts without_levels(const StudyFacts& study, const ScenarioFacts& scenario) {
    ScenarioFacts kept = scenario;
    std::erase_if(kept.conditions, [&](const ConditionFacts& condition) {
        const ConditionFacts* const reference = reference_of(study, scenario, condition);
        return reference != nullptr && !stands_out(condition, *reference);
    });
    return kept;
}

bool failed_always(const ConditionFacts& condition) {
    return condition.complete_runs == 0 && !condition.failed.empty();
}

/// The scenario for tables: without the conditions that always failed, and without any where no other is
/// compared.
ScenarioFacts without_failed(ScenarioFacts scenario) {
    const bool was_compared = std::ranges::any_of(scenario.conditions, &ConditionFacts::is_compared);
    std::erase_if(scenario.conditions, failed_always);
    if (was_compared && std::ranges::none_of(scenario.conditions, &ConditionFacts::is_compared))
        scenario.conditions.clear();
    return scenario;
}

void append_verdict(const ScenarioFacts& scenario, const ConditionFacts& condition, Tables tables,
                    std::string& text) {
    const Verdict words = verdict(scenario, condition, Script::plain);
    append_wrapped(fmt::format("{}{}: {}", condition.control_of.empty() ? "" : "For comparison, ",
                               label(condition), printable(words.answer())),
                   text);
    if (tables == Tables::essential && !condition.control_of.empty()) return;
    for (const std::string& fact : words.facts)
        append_wrapped("  - " + printable(fact), text);
}

/// Controls come after the others and have the answer alone: the rest is told under the condition of which a
/// part is off in them.
void append_verdicts(const ScenarioFacts& scenario, Tables tables, std::string& text) {
    for (const bool control : {false, true})
        for (const ConditionFacts& condition : scenario.conditions)
            if (condition.is_compared() && condition.control_of.empty() != control)
                append_verdict(scenario, condition, tables, text);
}

void append_measures(const ScenarioFacts& scenario, Tables tables, std::string& text) {
    const bool has_emergency = emergency_vehicles(scenario) > 0;
    std::string rows;
    for (const MeasureInfo& measure : measures()) {
        const bool wanted = tables == Tables::all || is_essential(measure.measure);
        if (wanted && (has_emergency || !is_about_emergency(measure)))
            append_measure(scenario, measure, rows);
    }
    if (has_emergency) append_response(scenario, tables, rows);
    if (!rows.empty())
        fmt::format_to(std::back_inserter(text), "\n{:<{}}{:>7}  {:<14} {:>7}  {:<14} {}\n{:-<{}}\n{}",
                       "Measure, condition", label_width, "mean", "95 % interval", "diff.", "95 % interval",
                       "effect", "", page_width, rows);
    if (tables == Tables::all && has_emergency && !rows.empty()) append_tails(scenario, text);
    if (tables == Tables::all) append_signals(scenario, text);
}

void append_scenario(const ScenarioFacts& scenario, Tables tables, std::string& text) {
    append_head(scenario, text);
    append_wrapped(coarse_step_sentence(scenario.step_length_s), text);
    append_wrapped(incidents_sentence(scenario, Script::plain), text);
    append_wrapped(printable(scenario.outlook), text);
    const ScenarioFacts shown = without_failed(scenario);
    if (const std::string caption = published_caption(scenario);
        !caption.empty() && !shown.conditions.empty()) {
        text += fmt::format("\n{}\n", printable(caption));
        append_published_table(shown, text);
    }
    append_measures(shown, tables, text);
    text += '\n';
    append_wrapped(printable(uneven_runs_sentence(shown)), text);
    if (tables == Tables::all) append_censored(scenario, text);
    const std::string wide = wide_edges_sentence(scenario);
    if (tables == Tables::all && !wide.empty()) append_wrapped(wide, text);
    if (tables == Tables::all) append_leases(scenario, text);
    append_failed(scenario, text);  // last, where a terminal shows them
    append_verdicts(scenario, tables, text);
}

/// What the words of the tables mean.
void append_legend(std::string& text) {
    append_wrapped(
        "here: mean and half width of its 95 % interval; (<x): upper end of an asymmetric interval, as none "
        "reaches below 0. Travel time of emergency vehicles (EV), all: the measure of the verdicts; an EV "
        "that did not arrive counts with the horizon. lost EVs, hit EVs, unchecked: more EVs than in the "
        "baseline did not arrive, they are shown to collide more often (the interval lies above 0), or "
        "safety "
        "checks were off, so neither a benefit nor the absence of an effect can be claimed. diff.: mean of "
        "the paired differences to the baseline of the same replication; "
        "better or worse when its interval excludes 0; negligible when an EV's time changes by less than "
        "--least-difference.",
        text);
}

}  // namespace

std::string console_tables(const StudyFacts& study, Tables tables) {
    std::string text = planned_table(study);
    if (tables == Tables::all) append_legend(text);
    bool any_unsafe = false;
    for (const ScenarioFacts& scenario : study.scenarios) {
        for (const Sensitivity& sensitivity : study.sensitivities) {
            if (sensitivity.scenario == scenario.name)
                append_wrapped(printable(sensitivity_sentence(sensitivity)) + ".", text);
        }
        append_scenario(tables == Tables::all ? scenario : without_levels(study, scenario), tables, text);
        any_unsafe = any_unsafe || std::any_of(scenario.conditions.begin(), scenario.conditions.end(),
                                               [](const ConditionFacts& one) { return one.is_unchecked(); });
    }
    text += safe_table(failure_table(study.failure_curves));
    text += safe_table(sensitivity_table(
        study.sensitivities, tables == Tables::all ? SensitivityRows::all : SensitivityRows::with_effect));
    append_wrapped(few_seeds_sentence(study), text);
    if (std::ranges::any_of(study.scenarios, [](const auto& one) { return !one.published_as.empty(); }))
        append_wrapped(
            "published: the dissertation's number, one unseeded run on a network of its own; not a result of "
            "this study. Its single GraphSAGE row is repeated for two nets: as published and with corrected "
            "inputs.",
            text);
    if (tables == Tables::essential)
        append_wrapped("All measures, actions and what the words mean: --tables, or report.html.", text);
    if (any_unsafe) append_wrapped("(!): the simulator's safety checks were off in this condition.", text);
    return text;
}

}  // namespace clearway::report
