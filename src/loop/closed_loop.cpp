#include "loop/closed_loop.hpp"

#include <span>
#include <utility>

#include "loop/controller.hpp"

namespace clearway::loop {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

void ClosedLoop::begin(Controller controller, const LoopConfig& config) {
    controller_ = std::move(controller);
    true_links_ = metrics::TrueLinks(config.rules());
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
    if (!controller_) return {};
    commands_.clear();
    if (controller_->siren) controller_->siren->restore_all(commands_);
    if (controller_->privilege) controller_->privilege->restore_all(commands_);
    controller_->actuator->restore_all(commands_);
    session_.apply(commands_);
    return totals_of(*controller_);
}

void ClosedLoop::step() {
    const auto started = Clock::now();
    session_.step();
    const truth::Snapshot& snapshot = session_.snapshot();
    if (controller_) controller_->chain->observe(snapshot, session_.roster());
    if (listener_ != nullptr) listener_->on_step(snapshot, session_.roster());
    const bool decided = controller_ && decide(snapshot);
    if (controller_) act(snapshot, decided);
    std::span<const traffic::Lease> leases;
    if (controller_) leases = controller_->chain->leases();
    recorder_.step(snapshot, session_.roster(), session_.events(), leases);
    if (controller_ && controller_->chain->has_policy()) recorder_.signals(snapshot, signals_);
    if (listener_ != nullptr) tell_listener(snapshot, decided);

    ++timing_.steps;
    timing_.vehicle_steps += snapshot.size();
    const double step_s = session_.step_wall_time().value;
    timing_.simulator_s += step_s;
    timing_.coupling_s += seconds_since(started) - step_s;
}

bool ClosedLoop::decide(const truth::Snapshot& snapshot) {
    pipeline::DecisionChain& chain = *controller_->chain;
    if (!chain.has_policy() || !chain.decision_is_due()) return false;
    chain.decide();
    if (chain.observation().is_report) score(snapshot);
    return true;
}

void ClosedLoop::act(const truth::Snapshot& snapshot, bool decided) {
    pipeline::DecisionChain& chain = *controller_->chain;
    commands_.clear();
    if (controller_->siren) controller_->siren->step(snapshot, session_.roster(), session_, commands_);
    if (controller_->privilege) controller_->privilege->step(snapshot, session_.roster(), commands_);
    if (controller_->listeners) controller_->actuator->heed(controller_->listeners->step(snapshot));
    pipeline::Requests& requests = *controller_->requests;
    requests.step({chain.leases(), chain.unreachable(), decided, chain.decided_there()}, snapshot,
                  session_.roster());
    controller_->actuator->accept(requests.arrived(), snapshot.time, chain.unreachable());
    controller_->actuator->refuse(requests.lost(), "unheard");
    controller_->actuator->refuse(requests.outdated(), "outdated");
    controller_->actuator->step(snapshot, session_.roster(), session_, commands_);
    session_.apply(commands_);
    signals_ = controller_->actuator->signals();
    controller_->greens->step(signals_, snapshot, session_.roster());
    if (decided) chain.answer(signals_);
}

void ClosedLoop::score(const truth::Snapshot& snapshot) {
    true_links_.look(snapshot);
    recorder_.links(snapshot, true_links_, controller_->chain->belief());
}

void ClosedLoop::tell_listener(const truth::Snapshot& snapshot, bool decided) {
    trace::RecordedStep step{&snapshot, &session_.roster(), &session_.events(), nullptr, nullptr, {}};
    if (controller_) {
        const pipeline::DecisionChain& chain = *controller_->chain;
        if (decided || chain.observation().is_report) step.observation = &chain.observation();
        if (decided) step.belief = &chain.belief();
        step.leases = chain.leases();
        step.commands = commands_;
    }
    listener_->on_step_end(step);
}

}  // namespace clearway::loop
