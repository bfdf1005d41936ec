#include "actuation/detail/signal_control.hpp"

#include <algorithm>
#include <cassert>
#include <functional>
#include <utility>

#include "actuation/detail/ways.hpp"
#include "traffic/signal.hpp"

namespace clearway::actuation::detail {
namespace {

using traffic::Refusal;

/// Upper bound on a cycle, s: a program that never changes has none.
constexpr double longest_cycle_s = 180.0;

/// Ascending and without duplicates, whatever the order of a policy's links.
Links united(Links links, const Links& others) {
    links.insert(links.end(), others.begin(), others.end());
    std::ranges::sort(links);
    links.erase(std::unique(links.begin(), links.end()), links.end());
    return links;
}

bool overlap(const Links& left, const Links& right) {
    return std::ranges::any_of(left,
                               [&](std::uint16_t link) { return std::ranges::binary_search(right, link); });
}

}  // namespace

SignalControl::SignalControl(core::SignalIndex index, const roads::Network& network)
    : index_(index),
      signal_(network.signal(index)),
      inner_lanes_(signal_.links.size()),
      transition_(signal_),
      own_(signal_, keeps_step(index, network)) {
    assert(signal_.foes.size() == signal_.links.size());
    assert(signal_.crossings.size() == signal_.links.size());
    for (std::size_t link = 0; link < signal_.links.size(); ++link) {
        for (const roads::SignalLink& way : signal_.links[link]) {
            if (!way.via.exists()) continue;  // a crossing for people on foot
            const std::vector<core::LaneIndex> lanes = lanes_of_way(network, way);
            inner_lanes_[link].insert(inner_lanes_[link].end(), lanes.begin(), lanes.end());
        }
    }
}

void SignalControl::offer(const traffic::Lease& lease, Ledger& ledger) {
    assert(lease.target == traffic::Target(index_));
    const bool is_hold = std::holds_alternative<traffic::HoldGreen>(lease.action);
    (is_hold ? holds_ : adjustments_).offer(lease, ledger);
}

bool SignalControl::is_idle(core::Seconds now) const {
    return active() == 0 && stage_ == Stage::background_plan && now >= lockout_until_ && own_.is_in_step(now);
}

traffic::SignalStatus SignalControl::status(core::Seconds now) const {
    traffic::SignalStatus status;
    status.signal = index_;
    status.stage = stage_ == Stage::background_plan ? traffic::SignalStage::program
                   : stage_ == Stage::hold          ? traffic::SignalStage::dwell
                                                    : traffic::SignalStage::transition;
    if (stage_ != Stage::background_plan) status.held = way_.links;
    status.capped = capped_;
    if (own_.keeps_step())
        status.coordination = stage_ == Stage::background_plan && own_.is_in_step(now)
                                  ? traffic::Coordination::in_step
                                  : traffic::Coordination::out_of_step;
    for (const HeldLease& held : holds_.all()) {
        const auto& asked = std::get<traffic::HoldGreen>(held.lease.action);
        status.calls.push_back({held.lease.beneficiary,
                                united(asked.own_links.empty() ? asked.links : asked.own_links, {}),
                                status_of(held, now)});
    }
    return status;
}

traffic::RequestStatus SignalControl::status_of(const HeldLease& held, core::Seconds now) const {
    const bool in_program = stage_ == Stage::background_plan;
    if (capped_) return traffic::RequestStatus::max_presence;
    if (in_program && now.value < lockout_until_.value - time_tolerance_s)
        return traffic::RequestStatus::reservice_locked;
    if (!held.served || in_program) return traffic::RequestStatus::processing;
    const auto& asked = std::get<traffic::HoldGreen>(held.lease.action);
    const Links& own = asked.own_links.empty() ? asked.links : asked.own_links;
    const auto shows = [&](std::uint16_t link) { return link < shown_.size() ? shown_[link] : 'r'; };
    if (!std::ranges::all_of(own, [&](std::uint16_t link) { return traffic::is_green(shows(link)); }))
        return stage_ == Stage::hold ? traffic::RequestStatus::rejected : traffic::RequestStatus::processing;
    const bool yields = std::ranges::any_of(own, [&](std::uint16_t link) { return shows(link) == 'g'; });
    return yields ? traffic::RequestStatus::watch_other_traffic : traffic::RequestStatus::granted;
}

/// Links of the best lease and of all that are compatible with it. Leases that are already served come before
/// waiting ones, because a change costs both of them time.
Links SignalControl::requested(const SignalContext& around, Ledger& ledger) {
    std::vector<HeldLease*> order;
    order.reserve(holds_.size());
    for (HeldLease& held : holds_.all()) {
        const auto reason = reason_to_wait(held, around);
        if (!reason) {
            order.push_back(&held);
            continue;
        }
        held.served = false;
        LeaseQueue::refuse(held, *reason, ledger);
    }
    std::ranges::stable_sort(order, std::greater{}, [](const HeldLease* held) {
        return std::pair(held->lease.priority, held->served);
    });
    Links links;
    Links own;
    for (HeldLease* const held : order) {
        const auto& asked = std::get<traffic::HoldGreen>(held->lease.action);
        const Links& asked_own = asked.own_links.empty() ? asked.links : asked.own_links;
        Links both = united(links, asked.links);
        Links both_own = united(own, asked_own);
        held->served = links.empty() || !conflict(signal_, asked.links, links) ||
                       (!conflict(signal_, asked_own, own) && a_phase_serves(signal_, both, both_own));
        if (!held->served) {
            LeaseQueue::refuse(*held, Refusal::outranked, ledger);
            continue;
        }
        LeaseQueue::act(*held, ledger);
        links = std::move(both);
        own = std::move(both_own);
    }
    return links;
}

/// Why the controller does not grant a request now.
std::optional<Refusal> SignalControl::reason_to_wait(HeldLease& held, const SignalContext& around) const {
    if (!held.since) held.since = around.now;
    if (!around.timing.enabled) return Refusal::preemption_off;
    if (held.lease.priority < around.timing.least_priority) return Refusal::priority;
    const double waited_s = (around.now - *held.since).value;
    if (waited_s < around.timing.delay_s - time_tolerance_s) return Refusal::preemption_delay;
    return std::nullopt;
}

/// Whether a hold without a request must go on: it is shorter than its least duration or dwell.
bool SignalControl::must_go_on(const SignalContext& around) const {
    if (stage_ == Stage::background_plan || capped_ || way_.links.empty()) return false;
    if ((around.now - taken_since_).value < around.timing.minimum_duration_s - time_tolerance_s) return true;
    if (around.timing.dwell_s <= 0.0) return false;
    return stage_ != Stage::hold ||
           (around.now - stage_since_).value < around.timing.dwell_s - time_tolerance_s;
}

Links SignalControl::allowed_now(const SignalContext& around, Ledger& ledger) {
    const core::Seconds now = around.now;
    const SignalTiming& timing = around.timing;
    const bool in_program = stage_ == Stage::background_plan;
    if (!in_program && (now - taken_since_).value >= timing.hold_cap_s - time_tolerance_s) capped_ = true;
    const bool cooling = in_program && now.value < lockout_until_.value - time_tolerance_s;
    if (!capped_ && !cooling) {
        Links links = requested(around, ledger);
        return links.empty() && must_go_on(around) ? way_.links : links;
    }
    for (HeldLease& held : holds_.all()) {
        held.served = false;
        LeaseQueue::refuse(held, capped_ ? Refusal::hold_cap : Refusal::lockout, ledger);
    }
    return {};
}

void SignalControl::step(const SignalContext& around, Ledger& ledger,
                         std::vector<traffic::Command>& commands) {
    holds_.expire(around.now, ledger);
    adjustments_.expire(around.now, ledger);
    if (around.state.empty() || around.state.size() < signal_.links.size()) {
        holds_.drop_all(Refusal::signal_gone, ledger);
        adjustments_.drop_all(Refusal::signal_gone, ledger);
        stage_ = Stage::background_plan;
        return;
    }
    const Links links = allowed_now(around, ledger);
    const bool in_program = stage_ == Stage::background_plan;
    if (!asked_for_gap_) gap_awaited_.reset();
    asked_for_gap_ = false;
    if (in_program) own_.watch(around.state, around.now);
    if (in_program && links.empty()) return run_background_plan(around, ledger, commands);
    if (in_program) {
        shown_ = around.state;
        program_known_ = knows_program(around);
    }
    if (in_program || links != way_.links) {
        Way way = links.empty() ? plan_return(around, ledger) : plan_hold(links);
        const bool in_green = in_program || stage_ == Stage::hold;
        const bool goes_on =
            owes_green(way.target, around) || (in_green && waits_for_gap(way.target, around));
        if (goes_on) {
            if (!in_program) proceed(around, commands);
            return;
        }
        // A lease that joins or leaves does not restart the hold of one that is stuck.
        if (in_program || (!overlap(links, last_held_) && conflict(signal_, links, last_held_)))
            taken_since_ = around.now;
        begin(std::move(way), around);
    }
    proceed(around, commands);
}

/// Whether a green should go on for a vehicle that could only just stop. Never for longer than the timing
/// allows.
bool SignalControl::waits_for_gap(const std::string& target, const SignalContext& around) {
    const bool is_pressed = std::ranges::any_of(losing_links(around.state, target), [&](std::uint16_t link) {
        return link < signal_.links.size() &&
               std::ranges::any_of(signal_.links[link], [&](const roads::SignalLink& way) {
                   return std::ranges::binary_search(around.pressed(), way.from);
               });
    });
    if (!gap_awaited_) gap_awaited_ = around.now;
    asked_for_gap_ =
        is_pressed && (around.now - *gap_awaited_).value < around.timing.gap_wait_s - time_tolerance_s;
    return asked_for_gap_;
}

OwedGreen SignalControl::owed_by(const SignalTiming& timing) const {
    return [this, &timing](std::uint16_t link, std::uint32_t phase) {
        return owed_green_s(link, phase, timing);
    };
}

double SignalControl::owed_green_s(std::uint16_t link, std::optional<std::uint32_t> phase,
                                   const SignalTiming& timing) const {
    if (signal_.crossings[link]) return timing.walk_s;
    return std::max(timing.entry_green_s, least_green_s(signal_, link, phase));
}

/// Whether a link that would lose green has not had its least green.
bool SignalControl::owes_green(const std::string& target, const SignalContext& around) const {
    const auto phase = green_phase(signal_, around.state);
    return std::ranges::any_of(losing_links(around.state, target), [&](std::uint16_t link) {
        return link < signal_.links.size() && around.duties.history.green_s(link, around.now) <
                                                  owed_green_s(link, phase, around.timing) - time_tolerance_s;
    });
}

/// Another program may have been switched on, or one that is in no file that was read. The phases of SUMO's
/// controller NEMA are those of two rings: what it shows is no single one of them.
bool SignalControl::knows_program(const SignalContext& around) const {
    return signal_.controller != "NEMA" && around.self.running_program(index_) == signal_.program_id;
}

void SignalControl::run_background_plan(const SignalContext& around, Ledger& ledger,
                                        std::vector<traffic::Command>& commands) {
    const core::Seconds least_green(around.timing.least_green_s);
    HeldLease* const adjustment = adjustments_.best();
    if (adjustment == nullptr) {
        const auto back = own_.step_back(least_green, around.now);
        if (back && knows_program(around))
            commands.push_back(traffic::RestoreProgram{index_, back->phase, back->lasting});
        return;
    }
    const auto next = own_.next_after(least_green, around.now);
    if (!next || serves_any(around.state, std::get<traffic::AdjustGreen>(adjustment->lease.action).links))
        return;
    if (waits_for_gap(signal_.program[*next].state, around)) return;
    if (!knows_program(around)) return LeaseQueue::refuse(*adjustment, Refusal::unknown_program, ledger);
    commands.push_back(traffic::RestoreProgram{index_, next, first_duration(*next, around.timing)});
    LeaseQueue::act(*adjustment, ledger);
    own_.disturb(around.now);
}

SignalControl::Way SignalControl::plan_hold(const Links& links) const {
    std::string target = hold_state(signal_, shown_, links);
    Links gaining = green_links(target);
    return {links, std::move(target), std::move(gaining), std::nullopt};
}

std::optional<std::uint32_t> SignalControl::phase_after_hold(const SignalTiming& timing, Ledger& ledger) {
    HeldLease* const adjustment = adjustments_.best();
    const auto asked =
        adjustment == nullptr || !program_known_
            ? std::nullopt
            : best_phase(signal_, std::get<traffic::AdjustGreen>(adjustment->lease.action).links);
    const bool is_set = timing.exit_phase && program_known_ && *timing.exit_phase < signal_.program.size();
    const auto phase = is_set ? timing.exit_phase : asked;
    if (adjustment == nullptr) return phase;
    if (asked && asked == phase)
        LeaseQueue::act(*adjustment, ledger);
    else
        LeaseQueue::refuse(*adjustment,
                           !program_known_ ? Refusal::unknown_program
                           : asked         ? Refusal::exit_phase
                                           : Refusal::no_phase_serves,
                           ledger);
    return phase;
}

SignalControl::Way SignalControl::plan_return(const SignalContext& around, Ledger& ledger) {
    Way way;
    way.return_phase = phase_after_hold(around.timing, ledger);
    if (!way.return_phase && program_known_) {
        way.return_phase =
            own_.resume(owed_by(around.timing), core::Seconds(around.timing.least_green_s), around.now);
        way.in_turn = way.return_phase.has_value();
    }
    way.target.assign(shown_.size(), 'r');
    if (way.return_phase) {
        const std::string& state = signal_.program[*way.return_phase].state;
        way.target.replace(0, state.size(), state);
    }
    way.gaining = green_links(way.return_phase ? way.target : std::string(shown_.size(), 'G'));
    return way;
}

void SignalControl::begin(Way way, const SignalContext& around) {
    assert(way.target.size() == shown_.size());
    assert(std::ranges::none_of(way.target, traffic::is_yellow) && "a transition ends in green and red");
    way_ = std::move(way);
    if (!way_.links.empty()) last_held_ = way_.links;
    transition_.begin(shown_, way_.target, way_.gaining, around.now);
    if (stage_ == Stage::hold) stage_ = Stage::transition;
}

void SignalControl::enter(Stage stage, const std::string& state, core::Seconds now,
                          std::vector<traffic::Command>& commands) {
    if (stage_ == Stage::background_plan) own_.leave();
    if (stage_ == Stage::background_plan || state != shown_)
        commands.push_back(traffic::SetSignalState{index_, state});
    stage_ = stage;
    stage_since_ = now;
    shown_ = state;
}

/// What becomes red in this step may make room for what opens in it.
void SignalControl::clear_link_by_link(const SignalContext& around, std::vector<traffic::Command>& commands) {
    assert(shown_.size() == way_.target.size());
    const std::function<bool(std::uint16_t)> has_vehicle = [&](std::uint16_t link) {
        return std::ranges::any_of(inner_lanes_[link], [&](core::LaneIndex lane) {
            return std::ranges::binary_search(around.occupied, lane);
        });
    };
    const std::function<bool(std::uint16_t)> has_pedestrian = [&](std::uint16_t link) {
        return std::ranges::any_of(signal_.links[link], [&](const roads::SignalLink& way) {
            return around.self.has_pedestrian(way.to);
        });
    };
    const TransitionContext context{around.now, around.timing, around.duties, has_vehicle, has_pedestrian};
    std::string state = shown_;
    for (std::string next = transition_.next_state(state, context); next != state;
         next = transition_.next_state(state, context)) {
        state = next;
        around.duties.history.watch(state, around.now);
    }
    const bool is_over =
        std::ranges::none_of(state, traffic::is_yellow) && transition_.is_over(state, context);
    if (is_over) transition_.end();
    enter(is_over ? Stage::hold : Stage::transition, state, around.now, commands);
}

void SignalControl::proceed(const SignalContext& around, std::vector<traffic::Command>& commands) {
    if (stage_ != Stage::hold) clear_link_by_link(around, commands);
    if (stage_ == Stage::hold && way_.links.empty()) return_to_program(around.now, around.timing, commands);
}

/// For how long a phase lasts that the program is led to, before vehicles may prolong it. SUMO keeps the next
/// switch of a program that vehicles actuate where it was, however soon that is; a fixed one starts the phase
/// anew.
std::optional<core::Seconds> SignalControl::first_duration(std::uint32_t phase,
                                                           const SignalTiming& timing) const {
    if (signal_.fixed_time) return std::nullopt;
    assert(phase < signal_.program.size());
    const roads::Phase& led_to = signal_.program[phase];
    if (led_to.least_s <= 0.0) return core::Seconds(led_to.duration_s);
    return core::Seconds(std::max(led_to.least_s, std::min(led_to.duration_s, timing.least_green_s)));
}

void SignalControl::return_to_program(core::Seconds now, const SignalTiming& timing,
                                      std::vector<traffic::Command>& commands) {
    assert(stage_ == Stage::hold && way_.links.empty());
    auto lasting = way_.return_phase ? first_duration(*way_.return_phase, timing) : std::nullopt;
    if (way_.in_turn && signal_.fixed_time)
        lasting = core::Seconds(
            own_.resumed_s(*way_.return_phase, owed_by(timing), core::Seconds(timing.least_green_s), now));
    commands.push_back(traffic::RestoreProgram{index_, way_.return_phase, lasting});
    if (way_.return_phase) own_.disturb(now);
    stage_ = Stage::background_plan;
    const double cycle_s = std::min(own_.cycle_s(), longest_cycle_s);
    lockout_until_ = now + core::Seconds(capped_ ? std::max(timing.lockout_s, cycle_s) : timing.lockout_s);
    capped_ = false;
}

void SignalControl::restore(std::vector<traffic::Command>& commands) const {
    if (stage_ != Stage::background_plan) commands.push_back(traffic::RestoreProgram{index_});
}

}  // namespace clearway::actuation::detail
