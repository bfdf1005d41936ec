#pragma once

#include <sys/types.h>

#include "core/supervisor.hpp"
#include "experiment/run_job.hpp"

namespace clearway::loop {

/// Holds SIGCHLD back while it lives, so that the end of a child wakes `watch` up instead of being lost.
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
    int status = 0;  ///< Of waitpid.
};

/// Waits for the end of `child`, a child of this process that was forked a moment ago, and kills it (SIGKILL)
/// when it runs longer or holds more than allowed. Needs a ChildSignals that was there before the fork.
/// Throws core::EnvironmentError when there is no such child.
WatchedEnd watch(pid_t child, const experiment::RunLimits& limits);

}  // namespace clearway::loop
