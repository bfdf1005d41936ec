#pragma once

#include "core/strict_table.hpp"
#include "study/config.hpp"

namespace clearway::study::detail {

/// Reads `[plan]`, if the file has it, into a study whose scenarios and conditions are complete. `root` is
/// the whole file. With Extent::quick the plan is read for its errors alone: a trial confirms nothing.
void read_plan(core::StrictTable& root, Extent extent, StudyConfig& config);

}  // namespace clearway::study::detail
