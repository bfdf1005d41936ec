#pragma once

#include <sys/types.h>

#include "core/supervisor.hpp"
#include "experiment/run_job.hpp"

namespace clearway::loop {

/// Blocks SIGCHLD during its lifetime, so that the end of a child wakes `watch` instead of being lost.
class ChildSignals {
  public:
    ChildSignals();
    ~ChildSignals();
    ChildSignals(const ChildSignals&) = delete;
    ChildSignals& operator=(const ChildSignals&) = delete;
};

/// How a watched process ended.
struct WatchedEnd {
    core::EndedBy by = core::EndedBy::itself;
    int status = 0;  ///< As waitpid reports it.
};

/// Waits for the end of `child`, a child of this process forked just before, and kills it (SIGKILL) when it
/// exceeds a limit. Needs a ChildSignals created before the fork. Throws core::EnvironmentError when there is
/// no such child.
WatchedEnd watch(pid_t child, const experiment::RunLimits& limits);

}  // namespace clearway::loop
