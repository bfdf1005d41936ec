#pragma once

#include <vector>

#include "trace/step_listener.hpp"

namespace clearway::trace {

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
