#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "experiment/run_job.hpp"

namespace clearway::loop {

/// Runs the one condition of a job with a window as its `window` says, in a SUMO that is a child of this
/// process, and stores the run: the same bytes as without a window. SUMO's files lie in `work`, an absolute
/// path. Throws core::EnvironmentError when that SUMO does not start, core::Error with code incomplete when
/// its window is closed before the end, core::SimulatorError when it fails, core::ConflictError when the run
/// is there already and differs.
core::ExitCode run_shown(const experiment::RunJob& unit, const std::filesystem::path& work);

}  // namespace clearway::loop
