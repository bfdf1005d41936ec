#pragma once

#include <cstdint>
#include <string>

#include "report/facts.hpp"

namespace clearway::report {

/// How much of a study is printed.
enum class Tables : std::uint8_t {
    essential,  ///< Only two measures: EV travel time and the time loss of the others.
    all,
};

/// The results for a terminal of 100 columns: for each scenario a verdict on each condition, what failed, the
/// dissertation's table if the study is the dissertation's, and measures with their intervals and paired
/// differences. Plain text without colour; names are stripped of control characters.
std::string console_tables(const StudyFacts& study, Tables tables = Tables::all);

/// The same facts as one JSON object, with units in the field names; null for missing values.
std::string json_tables(const StudyFacts& study);

}  // namespace clearway::report
