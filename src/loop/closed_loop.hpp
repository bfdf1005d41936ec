#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "actuation/actuator.hpp"
#include "core/units.hpp"
#include "drivers/listeners.hpp"
#include "drivers/privilege.hpp"
#include "drivers/siren.hpp"
#include "experiment/loop_config.hpp"
#include "metrics/recorder.hpp"
#include "pipeline/decision_chain.hpp"
#include "pipeline/green_watch.hpp"
#include "pipeline/requests.hpp"
#include "sumo/session.hpp"
#include "trace/step_listener.hpp"

namespace clearway::loop {

using experiment::LoopConfig;

/// What implements a condition, ready to run.
struct Controller {
    std::unique_ptr<pipeline::DecisionChain> chain;
    std::unique_ptr<pipeline::Requests> requests;
    std::unique_ptr<actuation::Actuator> actuator;
    std::unique_ptr<pipeline::GreenWatch> greens;
    std::unique_ptr<drivers::Siren> siren;                    ///< Null if no driver reacts to a siren.
    std::unique_ptr<drivers::Listeners> listeners = nullptr;  ///< Null if no driver takes requests.
    std::unique_ptr<drivers::Privilege> privilege = nullptr;  ///< Null without privileges.
};

/// Where the wall time of a run went, s.
struct LoopTiming {
    double simulator_s = 0.0;  ///< SUMO's own step.
    /// Everything else: reading, sensing, graph, prediction, policy, commands, metrics.
    double coupling_s = 0.0;
    std::uint64_t steps = 0;
    std::uint64_t vehicle_steps = 0;
};

/// The only place that knows the order truth -> sensing -> prediction -> policy -> actuation -> simulator,
/// with metrics alongside. Every step of every run is made here; warm-ups and solo runs leave out the part
/// from sensing to actuation. Members throw core::SimulatorError as the session does. One run; one thread.
class ClosedLoop {
  public:
    /// Both outlive the loop. Until `begin`, the simulation runs without a controller.
    ClosedLoop(sumo::Session& session, metrics::Recorder& recorder)
        : session_(session), recorder_(recorder) {}

    /// From the next step on, `controller` senses, decides and acts. Resets `timing`.
    void begin(Controller controller, const LoopConfig& config);
    /// From the next step on, `listener` is told of each step; it outlives the loop and may be null.
    void tell(trace::StepListener* listener) { listener_ = listener; }

    /// Steps while a step of `step_length` does not go beyond `end`.
    void warm_up(core::Seconds end, core::Seconds step_length);
    /// Steps until no vehicle is left or `horizon` is reached.
    void run(core::Seconds horizon);
    /// Releases everything that the controller holds. Returns what became of its leases.
    metrics::LeaseTotals finish();

    /// Timing of the steps since `begin`, or of all steps before it.
    const LoopTiming& timing() const { return timing_; }

  private:
    void step();
    /// Returns whether a decision was made.
    bool decide(const truth::Snapshot& snapshot);
    void act(const truth::Snapshot& snapshot, bool decided);
    void score(const truth::Snapshot& snapshot);
    void tell_listener(const truth::Snapshot& snapshot, bool decided);

    sumo::Session& session_;
    metrics::Recorder& recorder_;
    std::optional<Controller> controller_;
    trace::StepListener* listener_ = nullptr;

    metrics::TrueLinks true_links_{graph::LinkRules{}};
    std::vector<traffic::Command> commands_;
    std::vector<traffic::SignalStatus> signals_;  ///< After the actuator's last step.
    LoopTiming timing_;
};

}  // namespace clearway::loop
