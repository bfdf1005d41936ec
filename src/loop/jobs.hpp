#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "experiment/attach_job.hpp"
#include "experiment/dataset_job.hpp"
#include "experiment/link_job.hpp"
#include "experiment/run_job.hpp"

namespace clearway::loop {

// What a worker does besides units of a study, each kind of job in a file of its own.

/// Runs the only condition of a job with a window as its `window` says, in a SUMO that is a child of this
/// process, and stores the run: the same bytes as without a window. SUMO's files are in `work`, an absolute
/// path. Throws core::EnvironmentError when SUMO does not start, core::Error with code incomplete when the
/// window is closed before the end, core::SimulatorError when SUMO fails, core::ConflictError when the run is
/// already stored and differs.
core::ExitCode run_shown(const experiment::RunJob& unit, const std::filesystem::path& work);

/// Runs the only condition of a job that is `live`, hands every step to its server, waits where the server
/// says, and stores the run: the same bytes as of a run that nobody watches. SUMO's files are in `work`. A
/// server that goes away ends the run. Throws core::EnvironmentError when there is no server,
/// core::Error with code incomplete when it goes away, core::SimulatorError when SUMO fails,
/// core::ConflictError when the run is already stored and differs.
core::ExitCode run_live(const experiment::RunJob& unit, const std::filesystem::path& work);

/// Attaches to the simulation that the job names, continues it under the job's condition until it is empty or
/// reaches its own end, and stores the run in its own run folder. Throws core::EnvironmentError when no
/// usable SUMO answers, core::InputError when its files cannot be used here, core::SimulatorError when the
/// simulation fails or the connection breaks.
core::ExitCode run_attached(experiment::AttachJob job);

/// Runs the simulation of the job, under its policies if it has any, and writes the data set into its output
/// folder. Prints one line per file written. Throws core::Error.
core::ExitCode record_dataset(const experiment::DatasetJob& job);

/// Runs the simulation of the job and writes one LinkRun per predictor. Throws core::Error.
core::ExitCode evaluate_links(const experiment::LinkJob& job);

}  // namespace clearway::loop
