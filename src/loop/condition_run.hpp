#pragma once

#include <chrono>

#include "experiment/run_key.hpp"
#include "loop/closed_loop.hpp"
#include "loop/controller.hpp"
#include "metrics/road_layout.hpp"
#include "results/record.hpp"

namespace clearway::loop {

/// What a condition starts in, whatever runs the simulation.
struct Stage {
    ControllerContext context;
    metrics::RoadLayout layout;
    core::Seconds horizon;
    trace::StepListener* listener = nullptr;  ///< May be null.
};

/// Runs a condition from where the loop stands to its end. Throws core::InputError for names or settings that
/// do not exist, core::SimulatorError as the session does.
metrics::LeaseTotals run_condition(ClosedLoop& loop, metrics::Recorder& recorder,
                                   const experiment::ConditionSpec& condition, Stage stage);

/// Provenance of a run of this program. Hashes and seeds are left to the caller.
experiment::Provenance own_provenance();

/// Times of a run that began at `started`, and the memory of this process.
results::RunTiming timing_of(const LoopTiming& spent, std::chrono::steady_clock::time_point started);

/// The record of a run from its parts; completes the provenance with the hash of the trace.
results::RunRecord record_of(const experiment::RunKey& key, const experiment::ConditionSpec& condition,
                             experiment::Provenance provenance, metrics::RunSummary summary);

}  // namespace clearway::loop
