#pragma once

#include <string>

#include "report/facts.hpp"

namespace clearway::report {

// What the policies of a condition asked for and what became of it, a sentence each. Plain text.

/// All that was asked, by policy and action; lane changes are named even if none was asked for.
std::string lease_sentence(const ConditionFacts& condition);

/// `Of P's 3,687 requests 99 % were never carried out, mostly refused as not_controllable: ...`, for each
/// policy of whose requests so few were carried out that the runs say little about it; those of which none
/// was are told by idle_sentence. Empty without one.
std::string refusals_sentence(const ConditionFacts& condition);

/// `Never acted: preempt_signals in 3 of 5 runs.`; empty where all acted.
std::string idle_sentence(const ConditionFacts& condition);

/// `Only changed the EV's own lane: corridor in 3 of 5 runs.`; empty where none did.
std::string own_lane_sentence(const ConditionFacts& condition);

}  // namespace clearway::report
