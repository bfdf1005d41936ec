#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "actuation/actuator.hpp"
#include "core/units.hpp"
#include "drivers/siren.hpp"
#include "experiment/loop_config.hpp"
#include "metrics/recorder.hpp"
#include "pipeline/decision_chain.hpp"
#include "sumo/session.hpp"
#include "trace/step_listener.hpp"

namespace clearway::loop {

using experiment::LoopConfig;

/// What a condition is made of, ready to run.
struct Machinery {
    std::unique_ptr<pipeline::DecisionChain> chain;
    std::unique_ptr<actuation::Actuator> actuator;
    std::unique_ptr<drivers::Siren> siren;  ///< Null where nobody yields to one.
};

/// Where the time of a run went, s of wall time.
struct LoopTiming {
    double simulator_s = 0.0;  ///< SUMO's own step.
    double coupling_s =
        0.0;  ///< Everything else: reading, sensing, graph, prediction, policy, commands, metrics.
    std::uint64_t steps = 0;
    std::uint64_t vehicle_steps = 0;
};

/// The only place that knows the order of the design: truth -> sensing -> prediction -> policy -> actuation
/// -> simulator, with metrics beside it. One run; one thread.
class ClosedLoop {
  public:
    /// All references outlive the loop. `listener` may be null.
    ClosedLoop(sumo::Session& session, Machinery machinery, const LoopConfig& config,
               metrics::Recorder& recorder, trace::StepListener* listener = nullptr);

    /// Steps until no vehicle is left or `horizon` is reached, then gives back all that is held.
    /// Throws core::SimulatorError as the session does.
    void run(core::Seconds horizon);

    const LoopTiming& timing() const { return timing_; }
    const actuation::Actuator& actuator() const { return *machinery_.actuator; }

  private:
    void step();
    void score(const truth::Snapshot& snapshot);
    void tell_listener(const truth::Snapshot& snapshot, bool decided);

    sumo::Session& session_;
    Machinery machinery_;
    metrics::Recorder& recorder_;
    trace::StepListener* listener_;

    metrics::TrueLinks true_links_;
    std::vector<traffic::Command> commands_;
    LoopTiming timing_;
};

}  // namespace clearway::loop
