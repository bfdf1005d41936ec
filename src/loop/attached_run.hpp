#pragma once

#include "core/error.hpp"
#include "experiment/attach_job.hpp"

namespace clearway::loop {

/// Attaches to the simulation that the job names, continues it under the job's condition until it is empty or
/// reaches its own end, and stores the run in its own run folder. Throws core::EnvironmentError when no
/// usable SUMO answers, core::InputError when its files cannot be used here, core::SimulatorError when the
/// simulation fails or the connection breaks.
core::ExitCode run_attached(experiment::AttachJob job);

}  // namespace clearway::loop
