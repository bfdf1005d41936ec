#pragma once

#include <optional>
#include <vector>

#include "analysis/summary.hpp"
#include "report/facts.hpp"

namespace clearway::report::detail {

/// An estimate as tables print it; without a mean if there is none.
Estimate estimate_from(const std::optional<analysis::Estimate>& estimate);

/// Safety, comfort and flow of a condition, with further rows if there are pedestrians. Empty without a
/// complete run.
std::vector<SafetyFacts> safety_of(const analysis::ConditionSummary& summary);

}  // namespace clearway::report::detail
