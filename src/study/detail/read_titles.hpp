#pragma once

#include <vector>

#include "core/strict_table.hpp"
#include "experiment/condition.hpp"
#include "study/config.hpp"
#include "study/detail/factors.hpp"

namespace clearway::study::detail {

/// Reads `[titles]`, whose keys are conditions, with and without their factors, and texts that factors give
/// them. `untouched` are the conditions as the file lists them. Returns the problems of titles that belong to
/// nothing: what they are for may stand under a misspelt key.
std::vector<core::Problem> read_titles(core::StrictTable& root,
                                       const std::vector<experiment::ConditionSpec>& untouched,
                                       const Factors& factors, Extent extent, StudyConfig& config);

/// Reads `[controls]`, of conditions as the file lists them. What factors make of a control belongs to what
/// the same factors make of its condition, or to the condition.
void read_controls(core::StrictTable& root, const std::vector<experiment::ConditionSpec>& untouched,
                   StudyConfig& config);

}  // namespace clearway::study::detail
