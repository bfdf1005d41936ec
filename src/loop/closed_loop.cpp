#include "loop/closed_loop.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace clearway::loop {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

/// Divides the time of a step among its phases.
class ClosedLoop::Stopwatch {
  public:
    /// Adds the time since the last call, but for that of another phase within it.
    void lap(double& phase_s, double other_s = 0.0) {
        const Clock::time_point now = Clock::now();
        phase_s += std::chrono::duration<double>(now - last_).count() - other_s;
        last_ = now;
    }

  private:
    Clock::time_point last_ = Clock::now();
};

void ClosedLoop::begin(const experiment::ConditionSpec& condition, const ControllerContext& context) {
    assert(!controller_ && "one condition a run");
    controller_.emplace(condition, context);
    true_links_ = metrics::TrueLinks(context.loop.rules());
    timing_ = {};
}

metrics::StandingReasons ClosedLoop::standing_reasons() const {
    return {.at_stop =
                [this](core::VehicleKey vehicle) {
                    return session_.is_stopped(vehicle) ||
                           (incidents_ && incidents_->holds(vehicle, session_));
                },
            .pedestrian_on = [this](core::LaneIndex crossing) { return session_.has_pedestrian(crossing); }};
}

void ClosedLoop::warm_up(core::Seconds end, core::Seconds step_length) {
    assert(!controller_ && step_length.value > 0.0);
    while (session_.time().value + step_length.value <= end.value)
        step();
}

void ClosedLoop::run(core::Seconds horizon) {
    assert(std::isfinite(horizon.value));
    while ((session_.expected_vehicles() > 0 || (dispatcher_ != nullptr && dispatcher_->is_waiting())) &&
           session_.time().value < horizon.value - core::clock_tolerance_s) {
        step();
        if (dispatcher_ != nullptr) dispatcher_->step(*this, horizon);
        for (TriedAtSteps* const each : trials_)
            each->look(*this, horizon);
    }
}

void ClosedLoop::send(const traffic::EmergencyDeparture& departure, bool before_incident) {
    session_.add(departure);
    if (before_incident && incidents_) incidents_->expect(core::vehicle_key(departure.id));
}

CopyEnd ClosedLoop::end_after(const std::function<bool()>& change, core::VehicleKey vehicle,
                              core::Seconds horizon, const std::filesystem::path& folder,
                              core::Seconds watched) {
    session_.continue_in(folder);
    listener_ = nullptr;
    trials_.clear();
    if (dispatcher_ != nullptr) dispatcher_->try_none();
    CopyEnd end{.arrival = horizon};
    if (!change()) return end;
    const core::Seconds watched_until = session_.time() + watched;
    bool has_arrived = false;
    while (session_.time().value < horizon.value - core::clock_tolerance_s &&
           (!has_arrived || session_.time().value + core::clock_tolerance_s < watched_until.value)) {
        const core::Seconds before = session_.time();
        step();
        if (dispatcher_ != nullptr) dispatcher_->step(*this, horizon);
        if (before.value + core::clock_tolerance_s < watched_until.value)
            end.others_s += (session_.time() - before).value * others_under_way();
        const auto& arrived = session_.events().arrived;
        if (has_arrived || !core::contains(arrived, vehicle)) continue;
        has_arrived = true;
        end.arrival = session_.time();
    }
    return end;
}

double ClosedLoop::others_under_way() const {
    const auto emergency = std::ranges::count(snapshot().vehicle_class, traffic::VehicleClass::emergency);
    return static_cast<double>(session_.expected_vehicles() - emergency);
}

bool ClosedLoop::keep_to(const traffic::SetRoute& way) {
    if (controller_) controller_->keep_way(way.vehicle);
    session_.stop_rerouting(way.vehicle);
    const std::uint64_t refused = session_.refused_commands();
    session_.apply(std::vector<traffic::Command>{way});
    return session_.refused_commands() == refused;
}

metrics::LeaseTotals ClosedLoop::finish() {
    if (!controller_) return {};
    commands_.clear();
    controller_->restore_all(commands_);
    session_.apply(commands_);
    metrics::LeaseTotals totals = controller_->totals();
    totals.commands_skipped = session_.skipped_commands();
    totals.commands_refused = session_.refused_commands();
    return totals;
}

void ClosedLoop::step() {
    Stopwatch watch;
    session_.step();
    const double step_s = session_.step_wall_time().value;
    watch.lap(timing_.phases.reading_s, step_s);
    const truth::Snapshot& snapshot = session_.snapshot();
    const bool decided = control(snapshot, watch);
    if (incidents_) incidents_->step(session_);
    std::span<const traffic::Lease> leases;
    if (controller_) leases = controller_->chain().leases();
    recorder_.step(snapshot, session_.roster(), session_.events(), leases);
    if (controller_ && controller_->chain().has_policy()) recorder_.signals(snapshot, controller_->signals());
    if (listener_ != nullptr) tell_listener(snapshot, decided);

    ++timing_.steps;
    timing_.vehicle_steps += snapshot.size();
    watch.lap(timing_.phases.recording_s);
    timing_.simulator_s += step_s;
}

bool ClosedLoop::control(const truth::Snapshot& snapshot, Stopwatch& watch) {
    const auto tell = [&] {
        if (listener_ != nullptr) listener_->on_step(snapshot, session_.roster());
    };
    if (!controller_) {
        tell();
        return false;
    }
    auto observed = controller_->observe(snapshot, session_.roster());
    watch.lap(timing_.phases.sensing_s);
    tell();
    watch.lap(timing_.phases.recording_s);
    const pipeline::DecisionChain& chain = controller_->chain();
    // Links are scored at reports.
    const bool others_read_links = listener_ != nullptr || chain.observation().is_report;
    auto decided = controller_->decide(
        std::move(observed), others_read_links ? prediction::Want::links : prediction::Want::places);
    const bool has_decision = decided.has_decision();
    const double predicted_s = has_decision ? chain.prediction_wall_time().value : 0.0;
    timing_.phases.prediction_s += predicted_s;
    watch.lap(timing_.phases.policy_s, predicted_s);
    if (has_decision && dispatcher_ != nullptr) dispatcher_->see(chain.belief());
    if (has_decision && chain.observation().is_report) {
        true_links_.look(snapshot);
        recorder_.links(snapshot, true_links_, chain.belief());
    }
    watch.lap(timing_.phases.recording_s);
    commands_.clear();
    auto acted = controller_->act(std::move(decided), session_, commands_);
    session_.apply(commands_);
    controller_->answer(std::move(acted));
    watch.lap(timing_.phases.actuation_s);
    return has_decision;
}

void ClosedLoop::tell_listener(const truth::Snapshot& snapshot, bool decided) {
    trace::RecordedStep step{&snapshot, &session_.roster(), &session_.events(), nullptr, nullptr, {}};
    if (controller_) {
        const pipeline::DecisionChain& chain = controller_->chain();
        if (decided || chain.observation().is_report) step.observation = &chain.observation();
        if (decided) step.belief = &chain.belief();
        step.leases = chain.leases();
        step.commands = commands_;
    }
    listener_->on_step_end(step);
}

}  // namespace clearway::loop
