#pragma once

#include "cli/run_plan.hpp"
#include "experiment/run_job.hpp"

namespace clearway::cli {

/// As `run_and_print`, with the first replication of the condition `shown` made in a window, before the other
/// runs. One that is in the folder already is shown again, and must come out equal. A new folder is removed
/// when the shown run does not come to its end. Answers also incomplete, when the window is closed before,
/// and conflict. Throws core::EnvironmentError, with the cure, where no window can be opened.
core::ExitCode show_and_print(const study::Plan& plan, const RunPlanOptions& options,
                              const experiment::ConditionSpec& shown, const experiment::WindowSpec& window);

}  // namespace clearway::cli
