#pragma once

#include <string>

#include "report/facts.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"

namespace clearway::report {

/// The condition that a scenario's first screen is about: the chosen one (ScenarioFacts::chosen); else of
/// those with a shown gain for emergency vehicles (EV) the one with the largest, or the cheapest of those
/// that gain as much, as far as pairs show, and are shown to cost the others less, or the simplest of those
/// that are less than the least relevant difference behind that and not shown to cost more (fewest policies,
/// settings, failures, repairs); else the one with the smallest EV travel time to which nothing is objected;
/// else the first that is compared. Conditions with a setting turned alone come last, and controls are left
/// out. Null if none is compared.
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

/// `While nothing fails, corridor lost 1 of 30 emergency vehicles: no gain can be claimed`, of a condition in
/// which something fails; else empty. Plain text.
std::string objection_without_failure(const ScenarioFacts& scenario, const ConditionFacts& condition);

}  // namespace clearway::report
