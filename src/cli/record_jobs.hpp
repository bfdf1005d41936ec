#pragma once

#include <vector>

#include "cli/worker_jobs.hpp"
#include "experiment/dataset_job.hpp"

namespace clearway::cli {

/// Records data sets with worker processes as `work_on` says; the lines are what the workers said about their
/// files, by replication. Job files and logs stand beside each job's scenario file.
WorkerResult record_jobs(const std::vector<experiment::DatasetJob>& jobs, unsigned processes);

}  // namespace clearway::cli
