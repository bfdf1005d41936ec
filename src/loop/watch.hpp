#pragma once

#include <sys/types.h>

#include "core/supervisor.hpp"
#include "experiment/run_job.hpp"

namespace clearway::loop {

/// Blocks SIGCHLD, SIGINT and SIGTERM during its lifetime, so that they wake `watch`: the end of a child is
/// not lost, and an interruption ends the child before this process. Whoever waits for this process then
/// knows that nothing is written any more.
class ChildSignals {
  public:
    ChildSignals();
    ~ChildSignals();
    /// Lets these signals through again: in a child after the fork, and before this process ends by one.
    static void release();
    ChildSignals(const ChildSignals&) = delete;
    ChildSignals& operator=(const ChildSignals&) = delete;
};

/// How a watched process ended.
struct WatchedEnd {
    core::EndedBy by = core::EndedBy::itself;
    int status = 0;        ///< As waitpid reports it.
    int interruption = 0;  ///< SIGINT or SIGTERM if one came, else 0. The child got it, too.
};

/// Waits for the end of `child`, a child of this process forked just before, and kills it (SIGKILL) when it
/// exceeds a limit; its parts in Python and what they started count towards that of memory. Needs a
/// ChildSignals created before the fork. Throws core::EnvironmentError when there is no such child.
WatchedEnd watch(pid_t child, const experiment::RunLimits& limits);

}  // namespace clearway::loop
