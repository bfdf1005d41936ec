#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/dataset_job.hpp"

namespace clearway::samples {

/// The replications of a data set: `first` to `first + count - 1`.
struct DatasetSeeds {
    std::uint32_t first = 0;
    std::uint32_t count = 1;
};

/// One job per replication of a scenario. `shared` says what to record and where to; scenario and network are
/// kept in `origin/` of the data set.
std::vector<experiment::DatasetJob> dataset_jobs(const experiment::DatasetJob& shared,
                                                 const std::string& scenario, const DatasetSeeds& seeds);

/// The file that keeps the job of a recording, next to the data set.
std::filesystem::path job_file(const experiment::DatasetJob& job);

/// Where a job works; removed at its end.
std::filesystem::path work_folder(const experiment::DatasetJob& job);

/// The files that a job will write.
std::vector<std::filesystem::path> files_of(const experiment::DatasetJob& job);

/// Throws core::InputError when the jobs would overwrite recordings of other jobs. The same jobs may be given
/// again. `scenario` is the text of the effective configuration.
void check_folder(const std::vector<experiment::DatasetJob>& jobs, const std::string& scenario);

}  // namespace clearway::samples
