#pragma once

#include <cstdint>
#include <string>

#include "report/facts.hpp"

namespace clearway::report {

/// How much of a study is printed.
enum class Tables : std::uint8_t {
    essential,  ///< Of the measures, the EV's travel time and what the others lose.
    all,
};

/// The results for a terminal of 100 columns: for each scenario a verdict on each condition, what failed, the
/// dissertation's table where the study is its own, and measures with their intervals and paired differences.
/// Plain text without colour; names are stripped of control characters. Allocates; no other effect.
std::string console_tables(const StudyFacts& study, Tables tables = Tables::all);

/// The same facts for machines: one JSON object, units in the names of fields, null for "not available".
std::string json_tables(const StudyFacts& study);

}  // namespace clearway::report
