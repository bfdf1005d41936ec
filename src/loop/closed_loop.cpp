#include "loop/closed_loop.hpp"

#include <utility>

namespace clearway::loop {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Half a millisecond, the resolution of SUMO's clock: times are sums of steps and carry rounding errors
/// below it.
constexpr double time_tolerance_s = 0.0005;

}  // namespace

ClosedLoop::ClosedLoop(sumo::Session& session, Machinery machinery, const LoopConfig& config,
                       metrics::Recorder& recorder, trace::StepListener* listener)
    : session_(session),
      machinery_(std::move(machinery)),
      recorder_(recorder),
      listener_(listener),
      true_links_(graph::LinkRules{.radius_m = config.link_radius_m}) {}

void ClosedLoop::run(core::Seconds horizon) {
    while (session_.expected_vehicles() > 0 && session_.time().value < horizon.value - time_tolerance_s) {
        step();
    }
    commands_.clear();
    if (machinery_.siren) machinery_.siren->restore_all(commands_);
    machinery_.actuator->restore_all(commands_);
    session_.apply(commands_);
}

void ClosedLoop::step() {
    const auto started = Clock::now();
    session_.step();
    const truth::Snapshot& snapshot = session_.snapshot();
    pipeline::DecisionChain& chain = *machinery_.chain;
    chain.observe(snapshot, session_.roster());
    if (listener_ != nullptr) listener_->on_step(snapshot, session_.roster());

    const bool decides = chain.has_policy() && chain.decision_is_due();
    if (decides) {
        chain.decide();
        if (chain.observation().is_report) score(snapshot);
    }
    commands_.clear();
    if (machinery_.siren) machinery_.siren->step(snapshot, session_.roster(), session_, commands_);
    machinery_.actuator->accept(chain.leases(), snapshot.time, chain.unreachable());
    machinery_.actuator->step(snapshot, session_.roster(), session_, commands_);
    session_.apply(commands_);
    recorder_.step(snapshot, session_.roster(), session_.events(), chain.leases());
    if (listener_ != nullptr) tell_listener(snapshot, decides);

    ++timing_.steps;
    timing_.vehicle_steps += snapshot.size();
    const double step_s = session_.step_wall_time().value;
    timing_.simulator_s += step_s;
    timing_.coupling_s += seconds_since(started) - step_s;
}

void ClosedLoop::score(const truth::Snapshot& snapshot) {
    true_links_.look(snapshot);
    recorder_.links(snapshot, true_links_, machinery_.chain->belief());
}

void ClosedLoop::tell_listener(const truth::Snapshot& snapshot, bool decided) {
    const pipeline::DecisionChain& chain = *machinery_.chain;
    trace::RecordedStep step{&snapshot, &session_.roster(), &session_.events(), nullptr, nullptr, {}};
    if (decided || chain.observation().is_report) step.observation = &chain.observation();
    if (decided) step.belief = &chain.belief();
    step.leases = chain.leases();
    step.commands = commands_;
    listener_->on_step_end(step);
}

}  // namespace clearway::loop
