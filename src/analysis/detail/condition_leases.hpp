#pragma once

#include <vector>

#include "analysis/detail/pairing.hpp"
#include "analysis/summary.hpp"

namespace clearway::analysis::detail {

/// Leases of all runs by policy and action, in that order.
std::vector<metrics::LeaseRow> leases_of(const Runs& runs);

/// The parts of a condition that acted in no run, or on EVs alone, in at least one of its runs.
std::vector<IdlePart> idle_parts(const Runs& runs, const experiment::ConditionSpec& condition);

}  // namespace clearway::analysis::detail
