#pragma once

#include <cstdint>
#include <string>

#include "report/facts.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"

namespace clearway::report {

/// The condition that a scenario's first screen is about: of those with a shown gain for emergency vehicles
/// (EV) the one with the largest, or the simplest of those that are less than the least relevant difference
/// behind it (fewest policies, settings, failures, repairs); else the one with the smallest EV travel time to
/// which nothing is objected; else the first that is compared. Conditions with a setting turned alone come
/// last, and controls are left out. Null if none is compared.
const ConditionFacts* featured_condition(const StudyFacts& study, const ScenarioFacts& scenario);

/// One sentence made from the figures of a condition: `corridor saves ambulances 26 s a trip (24 %); other
/// drivers lose 4.6 s each; no collision in 30 runs.` It claims what `effect_of` shows and nothing else.
/// Plain text, not escaped.
std::string scenario_headline(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

/// The longest EV trip of the condition and of its baseline; empty if no EV entered. Plain text.
std::string worst_trips(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
/// The locks of the condition and of its baseline; empty if there are none. Plain text.
std::string locks_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition);

/// Which roads are blocked, from when to when, and when that is known; empty without incidents. Plain text.
std::string incidents_sentence(const ScenarioFacts& scenario, Script script);

/// How many of the scenario's conditions help, and that the featured one is the largest of several gains;
/// empty if only one is compared. Plain text.
std::string among_conditions(const StudyFacts& study, const ScenarioFacts& scenario);

/// A tile of the first screen: what was measured, the figure in large letters, what it means. Plain text.
struct Tile {
    const char* subject = "";
    std::string figure;
    std::string meaning;
    std::vector<std::string> details = {};  ///< What else is known of it, a line each.
    enum class Tone : std::uint8_t { neutral, better, worse } tone = Tone::neutral;
};
Tile emergency_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
/// Of the EVs that came to a closed road in the baseline, or that none did.
Tile incident_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
Tile others_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
Tile safety_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

/// Whether a condition was run often enough to say what is said of its EV travel time.
struct Badge {
    enum class Runs : std::uint8_t { enough, too_few } runs = Runs::too_few;
    std::string words;  ///< Plain text.
};
Badge badge_of(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

}  // namespace clearway::report
