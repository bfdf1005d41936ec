#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/units.hpp"
#include "loop/controller.hpp"
#include "loop/dispatcher.hpp"
#include "loop/incidents.hpp"
#include "loop/trials.hpp"
#include "metrics/recorder.hpp"
#include "results/record.hpp"
#include "sumo/session.hpp"
#include "trace/step_listener.hpp"

namespace clearway::loop {

/// Where the wall time of a run went, s.
struct LoopTiming {
    double simulator_s = 0.0;    ///< SUMO's own step.
    results::PhaseTimes phases;  ///< Of everything else.
    std::uint64_t steps = 0;
    std::uint64_t vehicle_steps = 0;
};

/// How a copy of a run ended.
struct CopyEnd {
    core::Seconds arrival;  ///< Of the vehicle, or the horizon.
    /// Time of vehicles other than emergency vehicles while it was watched, summed: of those on the road, of
    /// those that wait to enter, and of those that are not due yet, which is the same in every copy.
    double others_s = 0.0;
};

/// Every step of every run is made here: the simulator, then the controller (whose types know the order of
/// its parts), with metrics alongside; warm-ups and solo runs have no controller. Members throw
/// core::SimulatorError as the session does. One run; one thread.
class ClosedLoop {
  public:
    /// Both outlive the loop. Until `begin`, the simulation runs without a controller.
    ClosedLoop(sumo::Session& session, metrics::Recorder& recorder)
        : session_(session), recorder_(recorder) {}

    /// From the next step on, a controller of this condition senses, decides and acts. Resets `timing`.
    /// Throws as the controller does.
    void begin(const experiment::ConditionSpec& condition, const ControllerContext& context);
    /// From the next step on, `listener` is told of each step; it outlives the loop and may be null.
    void tell(trace::StepListener* listener) { listener_ = listener; }
    /// From the next step on, these look at each step of `run`; they outlive the loop.
    void try_choices(std::vector<TriedAtSteps*> trials) { trials_ = std::move(trials); }
    /// From the next step on, calls are answered by `dispatcher`; it outlives the loop, and may be null.
    void answer_calls(Dispatcher* dispatcher) { dispatcher_ = dispatcher; }
    /// Adds an emergency vehicle; `before_incident`: it is called to a road that an incident closes.
    void send(const traffic::EmergencyDeparture& departure, bool before_incident);

    /// From the next step on, these incidents block roads.
    void block(Incidents incidents) { incidents_.emplace(std::move(incidents)); }
    metrics::IncidentCounts incident_counts() const {
        return incidents_ ? incidents_->counts() : metrics::IncidentCounts{};
    }

    /// Steps while a step of `step_length` does not go beyond `end`.
    void warm_up(core::Seconds end, core::Seconds step_length);
    /// Steps until no vehicle is left and no call to come, or `horizon` is reached.
    void run(core::Seconds horizon);
    /// In a copy of the run, after `change`: drives on until the vehicle has arrived, and for `watched` at
    /// least; at once to `horizon` where `change` says that it cannot be done. Outputs go to `folder`.
    CopyEnd end_after(const std::function<bool()>& change, core::VehicleKey vehicle, core::Seconds horizon,
                      const std::filesystem::path& folder, core::Seconds watched = {});
    /// In a copy of the run, and for LoopConfig::best_way_taken: the vehicle drives this way, which nothing
    /// changes any more. Returns whether SUMO knows the way.
    bool keep_to(const traffic::SetRoute& way);
    /// Likewise, and for LoopConfig::best_hold_taken: see Controller.
    void hold_from(policy::RequestKey request, core::Seconds time) {
        if (controller_) controller_->hold_from(request, time);
    }
    /// Releases everything that the controller holds. Returns what became of its leases.
    metrics::LeaseTotals finish();

    /// Asks the session, which outlives what is returned.
    metrics::StandingReasons standing_reasons() const;

    /// Of the last step.
    const truth::Snapshot& snapshot() const { return session_.snapshot(); }
    const truth::Events& events() const { return session_.events(); }
    const traffic::Roster& roster() const { return session_.roster(); }

    /// Timing of the steps since `begin`, or of all steps before it.
    const LoopTiming& timing() const { return timing_; }

  private:
    class Stopwatch;

    void step();
    /// The controller's part of a step. Returns whether a decision was made.
    bool control(const truth::Snapshot& snapshot, Stopwatch& watch);
    void tell_listener(const truth::Snapshot& snapshot, bool decided);
    /// Those that are loaded and have not arrived.
    double others_under_way() const;

    sumo::Session& session_;
    metrics::Recorder& recorder_;
    std::optional<Incidents> incidents_;
    std::optional<Controller> controller_;
    trace::StepListener* listener_ = nullptr;
    std::vector<TriedAtSteps*> trials_;
    Dispatcher* dispatcher_ = nullptr;

    metrics::TrueLinks true_links_{graph::LinkRules{}};
    std::vector<traffic::Command> commands_;
    LoopTiming timing_;
};

}  // namespace clearway::loop
