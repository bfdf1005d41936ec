#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "experiment/run_job.hpp"

namespace clearway::loop {

/// Runs the only condition of a job that is `live`, hands every step to its server, waits where the server
/// says, and stores the run: the same bytes as of a run that nobody watches. SUMO's files are in `work`. A
/// server that goes away ends the run. Throws core::EnvironmentError when there is no server,
/// core::Error with code incomplete when it goes away, core::SimulatorError when SUMO fails,
/// core::ConflictError when the run is already stored and differs.
core::ExitCode run_live(const experiment::RunJob& unit, const std::filesystem::path& work);

}  // namespace clearway::loop
