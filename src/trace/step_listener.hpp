#pragma once

#include "trace/recording.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::trace {

/// Watches a run step by step, for data sets and traces. It sees the truth, so nothing that makes decisions
/// may be a listener.
class StepListener {
  public:
    StepListener() = default;
    StepListener(const StepListener&) = delete;
    StepListener& operator=(const StepListener&) = delete;
    virtual ~StepListener() = default;
    /// After sensing, before any decision.
    virtual void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) = 0;
    /// At the end of the step, with what was reported and decided in it. `step` is valid only during the
    /// call.
    virtual void on_step_end(const RecordedStep& /*step*/) {}
};

}  // namespace clearway::trace
