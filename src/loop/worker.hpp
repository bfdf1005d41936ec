#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace clearway::loop {

/// Does the job (experiment::Job) that a file holds: the work of one process. A run job answers ok when each
/// of its conditions has a record of its run or of its failure, and environment or conflict when a run ends
/// so. Throws core::Error: of a run job, for faults before the first condition starts; of the others as
/// run_shown, record_dataset, evaluate_links and run_attached do.
core::ExitCode work_on(const std::filesystem::path& job_file);

}  // namespace clearway::loop
