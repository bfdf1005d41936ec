#include "report/verdict.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

const char* effect_class(Effect effect) {
    if (effect == Effect::better) return "effect better";
    if (effect == Effect::worse) return "effect worse";
    return "effect";
}

std::string verdict_entry(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const Verdict words = verdict(scenario, condition, Script::typeset);
    const Effect effect = condition.objections.on_emergency()
                              ? Effect::worse
                              : effect_of(condition, Measure::emergency_restricted_time);
    std::string facts;
    for (const std::string& fact : words.facts)
        facts += fmt::format("<li>{}</li>", escaped(fact));
    if (!facts.empty()) facts = "<ul>" + facts + "</ul>";
    return fmt::format("<dt>{}</dt><dd><span class=\"{}\">{}</span>: {}{}</dd>\n", condition_label(condition),
                       effect_class(effect), escaped(words.finding), escaped(words.figures), facts);
}

/// Whether nothing is shown of a condition, on either side.
bool shows_nothing(const ConditionFacts& condition) {
    const auto none = [&](Measure measure) {
        const Effect effect = effect_of(condition, measure);
        return effect == Effect::none_shown || effect == Effect::negligible;
    };
    return none(Measure::emergency_restricted_time) && none(Measure::other_time_loss) &&
           effect_of(condition, Measure::collisions) != Effect::worse && condition.failed.empty();
}

std::string fold(std::size_t count, const char* of_what, const std::string& entries) {
    if (count == 0) return {};
    return fmt::format("<details class=\"fold\"><summary>{} {}</summary><dl>{}</dl></details>",
                       counted(count, "condition"), of_what, entries);
}

/// Verdicts of a scenario. Folded are those of a setting turned alone that say the same as the condition at
/// its defaults, and several that show nothing.
std::string verdict_card(const StudyFacts& study, const ScenarioFacts& scenario) {
    const auto nulls = std::ranges::count_if(scenario.conditions, [](const ConditionFacts& condition) {
        return condition.is_compared() && shows_nothing(condition);
    });
    std::string entries;
    std::string alike;
    std::string null;
    std::size_t alike_count = 0;
    std::size_t null_count = 0;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.is_compared()) continue;
        const ConditionFacts* const reference = reference_of(study, scenario, condition);
        const std::string entry = verdict_entry(scenario, condition);
        if (reference != nullptr && !stands_out(condition, *reference)) {
            alike += entry;
            ++alike_count;
        } else if (nulls > 1 && shows_nothing(condition)) {
            null += entry;
            ++null_count;
        } else {
            entries += entry;
        }
    }
    if (!entries.empty()) entries = fmt::format("<dl>{}</dl>", entries);
    entries += fold(null_count, "without a shown effect on EVs or others", null);
    entries += fold(alike_count, "with a setting turned alone, whose finding on EVs is the same", alike);
    if (entries.empty()) entries = "<p>No condition was compared with a baseline.</p>";
    entries = coarse_step_note(scenario.step_length_s) + entries;
    return fmt::format("<div class=\"card\"><h3>{}</h3><small>{}</small>{}</div>\n", escaped(scenario.name),
                       counted(scenario.replications, "replication"), entries);
}

}  // namespace

void verdict_section(const StudyFacts& study, Writer& writer) {
    writer.markup(fmt::format("<p class=\"lead\">{}</p>\n", escaped(headline(study))));
    writer.markup(
        "<p>Each condition against its baseline: its effect on emergency vehicles (EV) and on the "
        "others.</p>\n<div class=\"cards\">\n");
    for (const ScenarioFacts& scenario : study.scenarios)
        writer.markup(verdict_card(study, scenario));
    writer.markup(
        "</div>\n<p class=\"note\">Differences are paired: condition and baseline share seed, demand, "
        "drivers and sensor failures. An effect is claimed only when the 95 % interval of the mean "
        "difference excludes 0; \u201cno effect shown\u201d does not prove that there is none. EV travel "
        "time is the restricted mean over all emergency vehicles (EV): one that did not arrive counts with "
        "the horizon. Regardless of the means, no benefit is claimed for a condition that loses more EVs "
        "than its baseline, whose EVs are shown to collide more often, or that ran without safety checks. "
        "Fewer than five "
        "replications give no interval and no effect: too few seeds.</p>\n");
    if (const std::string few = few_seeds_sentence(study); !few.empty())
        writer.markup(fmt::format("<p class=\"note\">{}</p>\n", escaped(few)));
}

}  // namespace clearway::report::detail
