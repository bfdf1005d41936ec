#pragma once

#include <string>
#include <vector>

#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report {

/// A condition beside the one of which a part is off in it.
struct Control {
    const ConditionFacts* condition = nullptr;
    /// EV travel time (`primary`), paired: with the part minus without it, s.
    MaybeEstimate part_s;
};

/// The controls of a condition, in the order of the study. They point into the scenario.
std::vector<Control> controls_of(const ScenarioFacts& scenario, const ConditionFacts& condition);

/// `Controls, each with a part of it off: deaf: 12.0 [10.0, 14.0] s of the gain are gone; blind: no loss is
/// shown (0.7 [-0.6, 2.1] s).` Empty without controls. Plain text.
std::string controls_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
/// The same for the first screen of a scenario: of the condition that it is about, or, where that has none,
/// of each that has some, after its title.
std::string controls_note(const ScenarioFacts& scenario, const ConditionFacts& featured, Script script);

}  // namespace clearway::report
