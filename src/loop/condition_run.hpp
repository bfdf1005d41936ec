#pragma once

#include <chrono>

#include "experiment/run_key.hpp"
#include "loop/closed_loop.hpp"
#include "loop/controller.hpp"
#include "metrics/road_layout.hpp"
#include "results/record.hpp"

namespace clearway::loop {

/// The context in which a condition starts, however the simulation is run.
struct Stage {
    ControllerContext context;
    metrics::RoadLayout layout;
    core::Seconds horizon;
    trace::StepListener* listener = nullptr;  ///< May be null.
};

/// Lets a condition begin at the next step of the loop. Throws core::InputError for unknown names or
/// settings.
void start_condition(ClosedLoop& loop, metrics::Recorder& recorder,
                     const experiment::ConditionSpec& condition, Stage stage);

/// Runs a condition from the current step of the loop to the end. Throws as above, and core::SimulatorError
/// as the session does.
metrics::LeaseTotals run_condition(ClosedLoop& loop, metrics::Recorder& recorder,
                                   const experiment::ConditionSpec& condition, Stage stage);

/// Provenance of a run of this program; the caller fills in hashes and seeds.
experiment::Provenance own_provenance();

/// Times of a run that began at `started`, and the memory that this process used.
results::RunTiming timing_of(const LoopTiming& spent, std::chrono::steady_clock::time_point started);

/// The record of a run from its parts; completes the provenance with the hash of the trace.
results::RunRecord record_of(const experiment::RunKey& key, const experiment::ConditionSpec& condition,
                             experiment::Provenance provenance, metrics::RunSummary summary);

}  // namespace clearway::loop
