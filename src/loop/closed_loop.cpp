#include "loop/closed_loop.hpp"

#include <cmath>
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
                       metrics::Recorder& recorder, StepListener* listener)
    : session_(session),
      machinery_(std::move(machinery)),
      config_(config),
      recorder_(recorder),
      listener_(listener) {
    rules_.radius_m = config.link_radius_m;
}

void ClosedLoop::run(core::Seconds horizon) {
    while (session_.expected_vehicles() > 0 && session_.time().value < horizon.value - time_tolerance_s) {
        step();
    }
    commands_.clear();
    machinery_.actuator->restore_all(commands_);
    session_.apply(commands_);
}

void ClosedLoop::step() {
    const auto started = Clock::now();
    session_.step();
    const truth::Snapshot& snapshot = session_.snapshot();
    machinery_.sensor->observe(snapshot, session_.roster(), observation_);
    if (listener_ != nullptr) listener_->on_step(snapshot, session_.roster());

    leases_.clear();
    if (!machinery_.parts.empty() && decision_is_due(snapshot.time)) decide(snapshot);
    commands_.clear();
    machinery_.actuator->accept(leases_, snapshot.time);
    machinery_.actuator->step(snapshot, session_.roster(), session_, commands_);
    session_.apply(commands_);
    recorder_.step(snapshot, session_.events(), leases_);

    ++timing_.steps;
    timing_.vehicle_steps += snapshot.size();
    const double step_s = session_.step_wall_time().value;
    timing_.simulator_s += step_s;
    timing_.coupling_s += seconds_since(started) - step_s;
}

bool ClosedLoop::decision_is_due(core::Seconds now) const {
    return now.value + time_tolerance_s >= static_cast<double>(decisions_) * config_.policy_period_s;
}

void ClosedLoop::decide(const truth::Snapshot& snapshot) {
    decisions_ = static_cast<std::uint64_t>(
                     std::floor((snapshot.time.value + time_tolerance_s) / config_.policy_period_s)) +
                 1;
    machinery_.predictor->predict(observation_, belief_);
    for (const auto& part : machinery_.parts) {
        part->act(belief_, leases_);
    }
    if (observation_.is_report) score(snapshot);
}

void ClosedLoop::score(const truth::Snapshot& snapshot) {
    builder_.build({snapshot.x_m, snapshot.y_m, snapshot.vehicle_class}, rules_, true_graph_);
    recorder_.links(snapshot, true_graph_, belief_);
}

}  // namespace clearway::loop
