#pragma once

#include "core/error.hpp"
#include "experiment/dataset_job.hpp"

namespace clearway::loop {

/// Runs the simulation of the job, under its policies if it has any, and writes the data set into its output
/// folder. Prints one line per file written. Throws core::Error.
core::ExitCode record_dataset(const experiment::DatasetJob& job);

}  // namespace clearway::loop
