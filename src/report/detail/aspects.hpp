#pragma once

#include <vector>

#include "experiment/condition_titles.hpp"
#include "report/facts.hpp"

namespace clearway::report::detail {

/// Gives the conditions of one scenario their titles, and in words all that they have
/// (ConditionFacts::aspects).
void give_titles(const experiment::ConditionTitles& titles, std::vector<ConditionFacts>& conditions);

}  // namespace clearway::report::detail
