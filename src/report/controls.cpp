#include "report/controls.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/verdict.hpp"

namespace clearway::report {
namespace {

/// What goes when the part is off.
std::string loss_words(const ConditionFacts& condition, const Control& control, Script script) {
    const std::string& title = control.condition->title;
    if (!control.condition->same_as.empty() && control.condition->same_as == control.condition->baseline)
        return fmt::format("{}: all of the gain is gone, each run is that of the baseline", title);
    if (!control.part_s) return fmt::format("{}: no complete pair of runs", title);
    MaybeEstimate lost = control.part_s;
    lost->mean = -lost->mean;
    if (lost->interval) lost->interval = analysis::Interval{-lost->interval->high, -lost->interval->low};
    const std::string amount = estimate(lost, {1, script}) + " s";
    switch (effect_of(control.part_s, Better::lower, condition.least_relevant(primary))) {
        case Effect::better:
            return fmt::format("{}: {} of the gain are gone", title, amount);
        case Effect::worse:
            return fmt::format("{}: trips are faster by {}", title,
                               estimate(control.part_s, {1, script}) + " s");
        case Effect::negligible:
            return fmt::format("{}: no relevant time is lost ({})", title, amount);
        case Effect::none_shown:
            return fmt::format("{}: no loss is shown ({})", title, amount);
        case Effect::too_few:
        case Effect::ruled_out:
        case Effect::undecided:
            break;
    }
    return fmt::format("{}: no verdict ({})", title, amount);
}

}  // namespace

std::vector<Control> controls_of(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    std::vector<Control> controls;
    for (const ConditionFacts& other : scenario.conditions) {
        if (other.control_of != condition.name()) continue;
        controls.push_back({&other, analysis::estimate_paired(condition.outcome(primary).values,
                                                              other.outcome(primary).values,
                                                              analysis::MetricKind::quantity)});
    }
    return controls;
}

std::string controls_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    std::vector<std::string> parts;
    for (const Control& control : controls_of(scenario, condition))
        parts.push_back(loss_words(condition, control, script));
    if (parts.empty()) return {};
    return fmt::format("Controls, each with a part of it off: {}.", fmt::join(parts, "; "));
}

std::string controls_note(const ScenarioFacts& scenario, const ConditionFacts& featured, Script script) {
    if (std::string own = controls_sentence(scenario, featured, script); !own.empty()) return own;
    std::vector<std::string> notes;
    for (const ConditionFacts& condition : scenario.conditions)
        if (const std::string of = controls_sentence(scenario, condition, script); !of.empty())
            notes.push_back(condition.title + ": " + of);
    return fmt::format("{}", fmt::join(notes, " "));
}

}  // namespace clearway::report
