#pragma once

#include <filesystem>
#include <optional>

#include "campaign/detail/run_cost.hpp"
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
/// Estimated wall time of the rest of a plan, and what the estimate rests on.
struct TimeLeft {
    double wall_s = 0.0;
    CostBasis basis = CostBasis::measured;
};
/// With `workers` processes; nothing when it cannot be estimated.
std::optional<TimeLeft> estimated_time_left(const study::Plan& plan, const std::filesystem::path& folder,
                                            unsigned workers);

}  // namespace clearway::campaign
