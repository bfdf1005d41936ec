#pragma once

#include <vector>

#include "cli/detail/worker_jobs.hpp"
#include "experiment/dataset_job.hpp"

namespace clearway::cli {

/// Records data sets with worker processes, through `work_on`. The lines of the result are what the workers
/// printed about their files, by replication. Job files and logs are next to each job's scenario file.
WorkerResult record_jobs(const std::vector<experiment::DatasetJob>& jobs, unsigned processes);

}  // namespace clearway::cli
