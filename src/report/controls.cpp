#include "report/controls.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiment/related_conditions.hpp"
#include "failures/failure_config.hpp"
#include "report/shared_sentences.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

/// What an effect adds to its figures.
const char* words_of(Effect effect) {
    switch (effect) {
        case Effect::better:
        case Effect::worse:
            return "";
        case Effect::negligible:
            return ", a mean below what counts";
        case Effect::none_shown:
            return ", no difference shown";
        case Effect::too_few:
        case Effect::ruled_out:
        case Effect::undecided:
            break;
    }
    return ", no verdict";
}

/// `, the same EV times in 9 of 10 runs`, or empty where none has.
std::string same_times_words(const ConditionFacts& condition, const ConditionFacts& control) {
    const analysis::Values& mine = condition.outcome(primary).values;
    const analysis::Values& theirs = control.outcome(primary).values;
    std::size_t same = 0;
    for (std::size_t run = 0; run < std::min(mine.size(), theirs.size()); ++run)
        same += mine[run] && mine[run] == theirs[run] ? 1 : 0;
    return same == 0 ? "" : fmt::format(", the same EV times in {} of {}", same, counted(mine.size(), "run"));
}

/// Whether each run of the one is a run of the other.
bool are_same(const ConditionFacts& condition, const ConditionFacts& other) {
    return other.same_as == condition.name() || condition.same_as == other.name();
}

/// Of what failing costs: p by Holm over all such costs of the scenario.
std::optional<double> holm_p_of_failing(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    std::vector<double> all;
    std::optional<std::size_t> own;
    for (const ConditionFacts& other : scenario.conditions) {
        const ConditionFacts* const working = working_of(scenario, other);
        if (working == nullptr || are_same(other, *working)) continue;
        const auto p = analysis::paired_t_p(other.outcome(primary).values, working->outcome(primary).values);
        if (!p) continue;
        if (other.name() == condition.name()) own = all.size();
        all.push_back(*p);
    }
    return own ? std::optional(analysis::holm(all)[*own]) : std::nullopt;
}

double report_interval_s(const ConditionFacts& condition) {
    return failures::failure_from(condition.condition.failure).report_interval_s;
}

/// Where reports are also rarer in what fails: they are no failure.
std::string rates_sentence(const ConditionFacts& condition, const ConditionFacts& working) {
    const double interval_s = report_interval_s(condition);
    const double usual_s = report_interval_s(working);
    const Effect cost = effect_of(paired_difference(condition, working, primary), Better::lower,
                                  condition.least_relevant(primary));
    if (interval_s == usual_s || are_same(condition, working) || !is_clear(cost)) return {};
    const auto often = [](double seconds) {
        return seconds > 0.0 ? fmt::format("every {:g} s", seconds) : std::string("at every step");
    };
    return fmt::format(
        " Reports come {} there, else {}, and part of it may be that: --failure report_interval_s={:g} "
        "tells.",
        often(interval_s), often(usual_s), interval_s);
}

/// What failing changes, and whether it is shown.
std::string failing_words(const ScenarioFacts& scenario, const ConditionFacts& condition,
                          const ConditionFacts& working, Script script) {
    if (are_same(condition, working)) return "every run is the same";
    if (working.objections.on_emergency())
        return fmt::format("cannot be said, as while nothing fails it {}",
                           analysis::emergency_objections(working.objections));
    const MaybeEstimate longer = paired_difference(condition, working, primary);
    if (!longer) return "no complete pair of runs";
    const Effect cost = effect_of(longer, Better::lower, condition.least_relevant(primary));
    const bool can_tell = is_clear(cost) || is_clear(effect_of(working, primary));
    const auto p = is_clear(cost) ? holm_p_of_failing(scenario, condition) : std::nullopt;
    const std::string doubt =
        p && *p > 1.0 - analysis::usual_level
            ? doubt_clause(fmt::format("p {} after Holm's correction", p_words(*p, script)))
            : "";
    return estimate(longer, {1, script, Sign::always}) +
           (can_tell ? words_of(cost) + doubt : ", but no gain is shown that could be lost") +
           same_times_words(condition, working);
}

std::string words_of(const ConditionFacts& condition, const Control& control, Script script) {
    const ConditionFacts& other = *control.condition;
    const std::string& title = other.title;
    if (!other.same_as.empty() && other.same_as == other.baseline)
        return title + ": every run is that of the baseline";
    if (are_same(condition, other))
        return title + ": every run is the same, so what is off there does nothing here";
    if (!control.difference_s) return title + ": no complete pair of runs";
    const std::string objection = analysis::emergency_objection_word(other.objections);
    return fmt::format(
        "{}{}: {}{}{}", title, objection.empty() ? "" : " (" + objection + ")",
        estimate(control.difference_s, {1, script, Sign::always}),
        words_of(effect_of(control.difference_s, Better::lower, condition.least_relevant(primary))),
        same_times_words(condition, other));
}

}  // namespace

std::vector<Control> controls_of(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    std::vector<Control> controls;
    for (const ConditionFacts& other : scenario.conditions) {
        if (other.control_of != condition.name()) continue;
        controls.push_back({&other, paired_difference(other, condition, primary)});
    }
    return controls;
}

const ConditionFacts* working_of(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const auto working = std::ranges::find_if(scenario.conditions, [&](const ConditionFacts& other) {
        return other.is_compared() && experiment::is_without_failure(other.condition, condition.condition);
    });
    return working == scenario.conditions.end() ? nullptr : &*working;
}

std::string failing_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const ConditionFacts* const working = working_of(scenario, condition);
    if (working == nullptr) return {};
    return fmt::format("What failing costs: EV travel time against the same while nothing fails, s: {}.{}",
                       failing_words(scenario, condition, *working, script),
                       rates_sentence(condition, *working));
}

std::string failing_note(const ScenarioFacts& scenario, const ConditionFacts& working, Script script) {
    constexpr std::size_t most_told = 4;
    std::vector<std::string> parts;
    std::string rates;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.control_of.empty() || working_of(scenario, condition) != &working) continue;
        parts.push_back(condition.title + ": " + failing_words(scenario, condition, working, script));
        if (rates.empty()) rates = rates_sentence(condition, working);
    }
    if (parts.empty()) return {};
    if (parts.size() > most_told) {
        parts.resize(most_told);
        parts.emplace_back("others: under Verdict");
    }
    return fmt::format("What failing costs, EV travel time against the same while nothing fails, s: {}.{}",
                       fmt::join(parts, "; "), rates);
}

std::string working_words(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const ConditionFacts* const working = working_of(scenario, condition);
    if (working == nullptr || !working->difference(primary)) return {};
    if (working->objections.on_emergency())
        return "while nothing fails: " + analysis::emergency_objections(working->objections);
    return estimate(working->difference(primary), {1, script, Sign::always}) + " s while nothing fails";
}

std::string controls_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    std::vector<std::string> parts;
    for (const Control& control : controls_of(scenario, condition))
        if (control.condition != working_of(scenario, condition))
            parts.push_back(words_of(condition, control, script));
    if (parts.empty()) return {};
    return fmt::format("Controls: with one part of it off, EV travel time changes by, s: {}.",
                       fmt::join(parts, "; "));
}

std::string controls_note(const ScenarioFacts& scenario, const ConditionFacts& featured, Script script) {
    if (std::string own = controls_sentence(scenario, featured, script); !own.empty()) return own;
    constexpr std::size_t most_told = 2;  // the verdicts tell all
    std::vector<std::string> notes;
    for (const ConditionFacts& condition : scenario.conditions)
        if (const std::string of = controls_sentence(scenario, condition, script); !of.empty())
            notes.push_back(condition.title + ": " + of);
    const std::size_t untold = notes.size() - std::min(notes.size(), most_told);
    notes.resize(notes.size() - untold);
    if (untold > 0)
        notes.push_back(fmt::format("Those of {}: under Verdict.", counted(untold, "other condition")));
    return fmt::format("{}", fmt::join(notes, " "));
}

}  // namespace clearway::report
