#include "loop/closed_loop.hpp"

#include <span>
#include <utility>

#include "loop/machinery.hpp"

namespace clearway::loop {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

void ClosedLoop::begin(Machinery machinery, const LoopConfig& config) {
    machinery_ = std::move(machinery);
    true_links_ = metrics::TrueLinks(graph::LinkRules{.radius_m = config.link_radius_m});
    timing_ = {};
}

void ClosedLoop::warm_up(core::Seconds end, core::Seconds step_length) {
    while (session_.time().value + step_length.value <= end.value)
        step();
}

void ClosedLoop::run(core::Seconds horizon) {
    while (session_.expected_vehicles() > 0 &&
           session_.time().value < horizon.value - core::clock_tolerance_s)
        step();
}

metrics::LeaseTotals ClosedLoop::finish() {
    if (!machinery_) return {};
    commands_.clear();
    if (machinery_->siren) machinery_->siren->restore_all(commands_);
    machinery_->actuator->restore_all(commands_);
    session_.apply(commands_);
    return totals_of(*machinery_->actuator);
}

void ClosedLoop::step() {
    const auto started = Clock::now();
    session_.step();
    const truth::Snapshot& snapshot = session_.snapshot();
    if (machinery_) machinery_->chain->observe(snapshot, session_.roster());
    if (listener_ != nullptr) listener_->on_step(snapshot, session_.roster());
    const bool decided = machinery_ && decide(snapshot);
    if (machinery_) act(snapshot);
    std::span<const traffic::Lease> leases;
    if (machinery_) leases = machinery_->chain->leases();
    recorder_.step(snapshot, session_.roster(), session_.events(), leases);
    if (listener_ != nullptr) tell_listener(snapshot, decided);

    ++timing_.steps;
    timing_.vehicle_steps += snapshot.size();
    const double step_s = session_.step_wall_time().value;
    timing_.simulator_s += step_s;
    timing_.coupling_s += seconds_since(started) - step_s;
}

bool ClosedLoop::decide(const truth::Snapshot& snapshot) {
    pipeline::DecisionChain& chain = *machinery_->chain;
    if (!chain.has_policy() || !chain.decision_is_due()) return false;
    chain.decide();
    if (chain.observation().is_report) score(snapshot);
    return true;
}

void ClosedLoop::act(const truth::Snapshot& snapshot) {
    const pipeline::DecisionChain& chain = *machinery_->chain;
    commands_.clear();
    if (machinery_->siren) machinery_->siren->step(snapshot, session_.roster(), session_, commands_);
    machinery_->actuator->accept(chain.leases(), snapshot.time, chain.unreachable());
    machinery_->actuator->step(snapshot, session_.roster(), session_, commands_);
    session_.apply(commands_);
}

void ClosedLoop::score(const truth::Snapshot& snapshot) {
    true_links_.look(snapshot);
    recorder_.links(snapshot, true_links_, machinery_->chain->belief());
}

void ClosedLoop::tell_listener(const truth::Snapshot& snapshot, bool decided) {
    trace::RecordedStep step{&snapshot, &session_.roster(), &session_.events(), nullptr, nullptr, {}};
    if (machinery_) {
        const pipeline::DecisionChain& chain = *machinery_->chain;
        if (decided || chain.observation().is_report) step.observation = &chain.observation();
        if (decided) step.belief = &chain.belief();
        step.leases = chain.leases();
        step.commands = commands_;
    }
    listener_->on_step_end(step);
}

}  // namespace clearway::loop
