#pragma once

#include <string>

#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report {

/// What a planned comparison has shown, as tables say it: `shown: less time`, `equivalent within 1.3 s`.
std::string finding_words(const analysis::PlannedFinding& finding, Script script);

/// What was compared, by the titles of the conditions: `Ours, outages - corridor, outages`.
std::string pair_words(const StudyFacts& study, const analysis::PlannedFinding& finding, Script script);

/// What is confirmatory in a study with a plan, and that the rest is not. Plain text.
std::string plan_sentence(const StudyFacts& study);

/// The confirmatory findings as a table for a terminal of 100 columns, and where the exploratory results
/// begin; empty without a plan.
std::string planned_table(const StudyFacts& study);

}  // namespace clearway::report
