#pragma once

#include <cstdint>
#include <string>

#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report {

/// What a paired difference shows. It follows from the 95 % interval and the least relevant difference alone.
enum class Effect : std::uint8_t {
    better,
    worse,
    negligible,  ///< The mean, or the whole interval, is smaller than the least relevant difference.
    none_shown,  ///< The interval includes 0.
    undecided,   ///< No interval: fewer than two complete pairs.
};

/// A bound of exactly 0 counts as included.
Effect effect_of(const Outcome& outcome, Better better);

/// One sentence on a condition against the baseline: whether EVs got through sooner, by how much, and what it
/// cost the others. Plain text, not escaped.
std::string verdict(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

/// One sentence for the whole study, from EV travel time of every condition but the baselines. Plain text.
std::string headline(const StudyFacts& study);

}  // namespace clearway::report
