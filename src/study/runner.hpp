#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>

#include "core/error.hpp"
#include "results/store.hpp"
#include "study/plan.hpp"

namespace clearway::study {

struct RunnerOptions {
    unsigned workers = 0;                  ///< Processes at one time; 0: one per core.
    std::filesystem::path worker_program;  ///< Empty: `clearway-run` beside this program.
    experiment::RunLimits limits;          ///< Of each run.
    int attempts = 3;                      ///< For signals and time limits: one try and two more.
    double termination_grace_s = 5.0;      ///< From SIGTERM to SIGKILL.
    /// Called for each damaged record that was found before anything runs; may be empty.
    std::function<void(const results::SetAside&)> on_set_aside = {};
};

/// How far a study is. Runs, not units.
struct StudyProgress {
    std::size_t done = 0;  ///< Complete, earlier ones included.
    std::size_t failed = 0;
    std::size_t total = 0;
    std::size_t resumed = 0;  ///< Complete before this start.
    double elapsed_s = 0.0;
};

/// How a study ended. `exit_code` is ok, runs_failed, interrupted or terminated.
struct StudyResult {
    core::ExitCode exit_code = core::ExitCode::ok;
    StudyProgress progress;
};

/// Runs what is missing in `store` with worker processes: `clearway-run FILE`. The contract with a worker:
///
/// - FILE is an experiment::RunJob as JSON; its conditions are those without a record.
/// - The worker stores each run that ends by results::Store::write, and each run that fails while the worker
///   lives by writing a results::RunError: it holds each run to the unit's limits and sees by which
///   signal it died. It exits 0 when every condition has one of the two.
/// - Any other end is a failure of the conditions that have neither: by signal, by time limit (of all runs of
///   the unit and one more for its warm-up; SIGTERM, then SIGKILL), by memory limit, by exit code 3 (bad
///   input) or another.
/// - Standard output and error go to the log file of the unit.
///
/// Records that do not fit their hashes are set aside first (results::Store::set_damaged_aside), and their
/// runs are made again.
///
/// Failures by signal and time limit are tried again; the others are not, neither now nor on resuming in the
/// same folder (bad input, memory, refusals of SUMO), unless the worker's program or the environment was at
/// fault (exit codes 4 and 127: then core::EnvironmentError is thrown once all children have ended). SIGINT
/// and SIGTERM end the children; what they finished is kept. `on_progress` is called a few times a second and
/// at the end. Throws core::EnvironmentError when another study works in the folder. Not thread-safe: signal
/// handlers are set for the duration of the call.
StudyResult run(const Plan& plan, const results::Store& store, const RunnerOptions& options,
                const std::function<void(const StudyProgress&)>& on_progress);

}  // namespace clearway::study
