#pragma once

#include "core/error.hpp"
#include "experiment/link_job.hpp"

namespace clearway::loop {

/// Runs the simulation of the job and writes one LinkRun per predictor. Throws core::Error.
core::ExitCode evaluate_links(const experiment::LinkJob& job);

}  // namespace clearway::loop
