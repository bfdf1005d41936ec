#pragma once

#include <vector>

#include "campaign/study_run.hpp"
#include "experiment/condition.hpp"
#include "server/live_server.hpp"
#include "study/config.hpp"

namespace clearway::campaign {

/// Runs that are shown to browsers while they happen.
struct LiveRequest {
    study::StudyConfig config;                       ///< With one replication and the baselines.
    std::vector<experiment::ConditionSpec> watched;  ///< Of its conditions, from left to right.
    server::LiveConfig server;  ///< Without a title; a token is drawn where the host needs one.
    RunOptions run;
};

/// Serves the first replication of the watched conditions in step, each from a worker of its own, then makes
/// what is missing and publishes the folder. Returns how the shown runs ended if they did not finish. Throws
/// as server::LiveServer and plan_for do.
core::ExitCode run_live(LiveRequest request);

}  // namespace clearway::campaign
