#pragma once

#include "campaign/study_run.hpp"
#include "experiment/run_job.hpp"

namespace clearway::campaign {

/// The job that makes the first replication of the condition `shown` of the plan, and nothing else.
experiment::RunJob unit_of(const study::Plan& plan, const experiment::ConditionSpec& shown);

/// As `complete` after prepare_run_folder, but the first replication of the condition `shown` runs in a
/// window, before the other runs. If the folder already holds this run, it is shown again and must give the
/// same record. If the shown run does not finish, a new folder is removed. Also returns incomplete, when the
/// window is closed early, and conflict. Throws core::EnvironmentError, with the cure, if no window can be
/// opened.
core::ExitCode show_and_print(const study::Plan& plan, const RunOptions& options,
                              const experiment::ConditionSpec& shown, const experiment::WindowSpec& window);

}  // namespace clearway::campaign
