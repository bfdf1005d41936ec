#pragma once

#include <string>

#include "report/facts.hpp"

namespace clearway::report {

/// The tables for a terminal of 110 columns: for each scenario the dissertation's table (means and published
/// numbers), every measure with its interval and its paired difference, and a verdict on each condition.
/// Plain text without colour; names are stripped of control characters. Allocates; no other effect.
std::string console_tables(const StudyFacts& study);

/// The same facts for machines: one JSON object, units in the names of fields, null for "not available".
std::string json_tables(const StudyFacts& study);

}  // namespace clearway::report
