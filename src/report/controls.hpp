#pragma once

#include <string>
#include <vector>

#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report {

/// A condition beside the one of which a part is off in it.
struct Control {
    const ConditionFacts* condition = nullptr;
    MaybeEstimate difference_s;  ///< EV travel time (`primary`), paired: without the part minus with it.
};

/// The controls of a condition, in the order of the study. They point into the scenario.
std::vector<Control> controls_of(const ScenarioFacts& scenario, const ConditionFacts& condition);

/// `-26.5 s while nothing fails`: EV travel time against the baseline, beside a condition in which something
/// fails and where the study runs both; else empty.
std::string working_words(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

/// The condition that does the same while nothing fails, if the study compares both; else null. Points into
/// the scenario.
const ConditionFacts* working_of(const ScenarioFacts& scenario, const ConditionFacts& condition);
/// `What failing costs: EV travel time against the same while nothing fails, s: +1.4 [-2.2, 5.0], no
/// difference shown.` Empty without such a condition.
std::string failing_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
/// The same for those in which something fails of a condition, after their titles, but for its controls.
std::string failing_note(const ScenarioFacts& scenario, const ConditionFacts& working, Script script);

/// `Controls: with one part of it off, EV travel time changes by, s: deaf: +12.0 [10.0, 14.0]; blind: +0.7
/// [-0.6, 2.1], no difference shown.` Empty without controls. Plain text.
std::string controls_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
/// The same for the first screen of a scenario: of the condition that it is about, or, where that has none,
/// of each that has some, after its title.
std::string controls_note(const ScenarioFacts& scenario, const ConditionFacts& featured, Script script);

}  // namespace clearway::report
