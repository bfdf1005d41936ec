#pragma once

#include <vector>

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

/// Passes every step on to several listeners, which outlive it.
class Listeners : public StepListener {
  public:
    void add(StepListener& listener) { listeners_.push_back(&listener); }
    bool empty() const { return listeners_.empty(); }
    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override {
        for (StepListener* const listener : listeners_) {
            listener->on_step(snapshot, roster);
        }
    }
    void on_step_end(const RecordedStep& step) override {
        for (StepListener* const listener : listeners_) {
            listener->on_step_end(step);
        }
    }

  private:
    std::vector<StepListener*> listeners_;
};

}  // namespace clearway::trace
