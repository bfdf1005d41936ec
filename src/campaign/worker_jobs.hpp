#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/process.hpp"
#include "experiment/dataset_job.hpp"
#include "experiment/job.hpp"
#include "experiment/run_job.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// The job that makes a stored run again, from the scenario and network of its run folder, into the run
/// folder `output`. The run is one of the manifest.
experiment::RunJob stored_job(const results::Store& store, const experiment::RunKey& key,
                              const std::filesystem::path& output);

/// Lines of a failed worker's log that are shown.
inline constexpr int shown_lines = 10;

/// Exit code of a command after one of its workers ended so.
core::ExitCode exit_code_of(const core::Exit& exit);

/// A job for one worker process and where its files are.
struct WorkerJob {
    std::string label;  ///< `merge replication 3`, for messages.
    experiment::Job job;
    std::filesystem::path file;               ///< Written before the worker starts.
    std::filesystem::path log;                ///< Both streams of the worker.
    std::vector<std::filesystem::path> work;  ///< Removed when the worker fails or is ended.
};

/// How the work ended.
struct WorkerResult {
    core::ExitCode exit_code = core::ExitCode::ok;
    std::vector<std::string> lines;  ///< Logs of the workers that did not fail, in the order of the jobs.
};

/// Runs the jobs with up to `processes` workers at a time (0: one per core), with progress on standard error.
/// A worker that fails is reported there and the others continue; the first failure decides the exit code.
/// SIGINT and SIGTERM end the workers: one that does not end within a few seconds is killed. `title` names
/// what is counted. Throws core::EnvironmentError when no worker can be started.
WorkerResult work_on(const std::vector<WorkerJob>& jobs, unsigned processes, const std::string& title);

/// Records data sets, through `work_on`. The lines of the result are what the workers printed about their
/// files, by replication. Job files and logs are next to each job's scenario file.
WorkerResult record_jobs(const std::vector<experiment::DatasetJob>& jobs, unsigned processes);

}  // namespace clearway::campaign
