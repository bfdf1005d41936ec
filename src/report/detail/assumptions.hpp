#pragma once

#include <string>

#include "report/facts.hpp"

namespace clearway::report::detail {

/// What the figures of a scenario rest on, from its stored scenario.toml: how its demand came about, how much
/// of it there is, and whether EVs of the baseline stop at red. Plain text, a sentence.
std::string assumptions_sentence(const std::string& configuration, const ScenarioFacts& scenario);

}  // namespace clearway::report::detail
