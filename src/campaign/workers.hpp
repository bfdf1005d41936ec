#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/error.hpp"
#include "core/supervisor.hpp"
#include "results/store.hpp"
#include "study/plan.hpp"

namespace clearway::campaign {

/// Which failed runs of an earlier call are tried again.
enum class RetriedRuns : std::uint8_t {
    ended_by_machine,  ///< By a signal, a limit or a failure of the machine (results::may_pass).
    all_failed,
};

/// How the units of a plan reach their workers.
struct WorkersOptions {
    unsigned workers = 0;                  ///< Processes at one time; 0: one per core.
    std::filesystem::path worker_program;  ///< Empty: `clearway-run` beside this program.
    experiment::RunLimits limits;          ///< Of each run.
    int attempts = 3;  ///< For errors by signal or time limit: the first try and two more.
    RetriedRuns retried = RetriedRuns::ended_by_machine;
    double termination_grace_s = 5.0;                ///< From SIGTERM to SIGKILL.
    core::Machine* machine = &core::this_machine();  ///< On which the workers run; not null.
    /// Called for each damaged record that was found before anything runs; may be empty.
    std::function<void(const results::SetAside&)> on_set_aside = {};
};

/// Progress of a study, in runs.
struct StudyProgress {
    std::size_t done = 0;  ///< Complete runs, including earlier ones.
    std::size_t failed = 0;
    std::size_t total = 0;
    std::size_t resumed = 0;  ///< Runs that were complete before this call.
    double elapsed_s = 0.0;
    double work =
        0.0;  ///< Share of the work of this call that is done, 0 to 1, that of running runs included.
};

/// How a study ended. `exit_code` is ok, runs_failed, interrupted or terminated.
struct StudyResult {
    core::ExitCode exit_code = core::ExitCode::ok;
    StudyProgress progress;
};

/// Makes the runs missing in `store` with worker processes, `clearway-run FILE`, or children of one that
/// serves (core::ForkServer). The contract with a worker:
///
/// - FILE is an experiment::RunJob as JSON; its conditions are those without a record.
/// - The worker holds each run to the unit's limits. It stores a finished run with results::Store::write, and
///   a results::RunError for a run that failed, including the signal by which it died. It exits 0 when every
///   condition has one of the two.
/// - With any other end of the worker, the conditions that have neither get an error: by signal, by time
/// limit
///   (that of all runs of the unit plus one for the warm-up; SIGTERM, then SIGKILL), by memory limit, by exit
///   code 3 (bad input) or another.
/// - Standard output and error go to the log file of the unit.
///
/// First, records that do not match their hashes are set aside (results::Store::set_damaged_aside) and their
/// runs are repeated.
///
/// Runs that end by signal or time limit are tried again. Runs with other errors (bad input, memory, refusals
/// of SUMO) are not in this call; when the study is resumed in the same folder, `retried` decides. When the
/// worker's program or the environment is at fault (exit codes 4 and 127), core::EnvironmentError is thrown
/// once all children have ended. SIGINT and SIGTERM end the children; finished runs are kept. `on_progress`
/// is called a few times per second and at the end. Throws core::EnvironmentError when another study runs in
/// the folder. Not thread-safe: sets signal handlers for the duration of the call.
StudyResult run_units(const study::Plan& plan, const results::Store& store, const WorkersOptions& options,
                      const std::function<void(const StudyProgress&)>& on_progress);

}  // namespace clearway::campaign
