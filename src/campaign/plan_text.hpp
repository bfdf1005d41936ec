#pragma once

#include <filesystem>
#include <optional>

#include "campaign/printout.hpp"
#include "campaign/study_run.hpp"
#include "study/plan.hpp"
#include "study/shard.hpp"

namespace clearway::campaign {

/// What a plan would do, for `--dry-run`: cells, runs, those already in the folder and those taken over from
/// another, and the estimated time and disk space of the rest.
Printout plan_printout(const study::Plan& plan, const RunOptions& options);
/// Prints that of a shard of a study, after the checks that precede its runs.
core::ExitCode print_plan(study::StudyConfig config, const study::Shard& shard, RunOptions options);
/// Estimated wall time of the rest of a plan with `workers` processes, s; nothing when it cannot be
/// estimated.
std::optional<double> estimated_time_left_s(const study::Plan& plan, const std::filesystem::path& folder,
                                            unsigned workers);

}  // namespace clearway::campaign
