#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
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
struct Controller {
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
/// -> simulator, with metrics beside it. Every step of every run is made here: those of a warm-up and of
/// vehicles alone on the road without the middle part. Members throw core::SimulatorError as the session
/// does. One run; one thread.
class ClosedLoop {
  public:
    /// Both outlive the loop. Until `begin`, the simulation goes on by itself.
    ClosedLoop(sumo::Session& session, metrics::Recorder& recorder)
        : session_(session), recorder_(recorder) {}

    /// From the next step on, `controller` senses, decides and acts. `timing` starts anew.
    void begin(Controller controller, const LoopConfig& config);
    /// From the next step on, `listener` is told of each; it outlives the loop and may be null.
    void tell(trace::StepListener* listener) { listener_ = listener; }

    /// Steps as long as a step of `step_length` does not pass `end`.
    void warm_up(core::Seconds end, core::Seconds step_length);
    /// Steps until no vehicle is left or `horizon` is reached.
    void run(core::Seconds horizon);
    /// Gives back all that the controller holds, and answers what became of its leases.
    metrics::LeaseTotals finish();

    /// Of all steps, or of those since `begin`.
    const LoopTiming& timing() const { return timing_; }

  private:
    void step();
    /// Answers whether something was decided.
    bool decide(const truth::Snapshot& snapshot);
    void act(const truth::Snapshot& snapshot);
    void score(const truth::Snapshot& snapshot);
    void tell_listener(const truth::Snapshot& snapshot, bool decided);

    sumo::Session& session_;
    metrics::Recorder& recorder_;
    std::optional<Controller> controller_;
    trace::StepListener* listener_ = nullptr;

    metrics::TrueLinks true_links_{graph::LinkRules{}};
    std::vector<traffic::Command> commands_;
    LoopTiming timing_;
};

}  // namespace clearway::loop
