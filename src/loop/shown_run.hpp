#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "experiment/run_job.hpp"

namespace clearway::loop {

/// Runs the only condition of a job with a window as its `window` says, in a SUMO that is a child of this
/// process, and stores the run: the same bytes as without a window. SUMO's files are in `work`, an absolute
/// path. Throws core::EnvironmentError when SUMO does not start, core::Error with code incomplete when the
/// window is closed before the end, core::SimulatorError when SUMO fails, core::ConflictError when the run is
/// already stored and differs.
core::ExitCode run_shown(const experiment::RunJob& unit, const std::filesystem::path& work);

}  // namespace clearway::loop
