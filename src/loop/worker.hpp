#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace clearway::loop {

/// Does the job (experiment::Job) in a file: the work of one process. A run job returns ok when each of its
/// conditions has a record of its run or its error, and environment or conflict when a run ends with that
/// code. Throws core::Error: for a run job, when something fails before the first condition starts; for other
/// jobs, as run_shown, record_dataset, evaluate_links and run_attached do.
core::ExitCode work_on(const std::filesystem::path& job_file);

}  // namespace clearway::loop
