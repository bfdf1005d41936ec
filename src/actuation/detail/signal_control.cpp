#include "actuation/detail/signal_control.hpp"

#include <algorithm>

#include "traffic/signal.hpp"

namespace clearway::actuation::detail {

SignalControl::SignalControl(core::SignalIndex index, const roads::Network& network)
    : index_(index), signal_(network.signal(index)), inner_lanes_(signal_.links.size()) {
    for (std::size_t link = 0; link < signal_.links.size(); ++link) {
        for (const roads::SignalLink& way : signal_.links[link]) {
            core::LaneIndex lane = way.via;
            while (lane.exists()) {
                inner_lanes_[link].push_back(lane);
                const auto onward = network.connections_from(lane);
                lane = onward.empty() ? core::LaneIndex::none() : onward.front().via;
            }
        }
    }
}

void SignalControl::offer(const traffic::Lease& lease, Ledger& ledger) {
    const bool is_hold = std::holds_alternative<traffic::HoldGreen>(lease.action);
    (is_hold ? holds_ : favours_).offer(lease, ledger);
}

bool SignalControl::is_idle(core::Seconds now) const {
    return active() == 0 && stage_ == Stage::own_program && now >= cool_until_;
}

/// Links of the best lease and of all others that go with it.
Links SignalControl::requested(Ledger& ledger) {
    Links links;
    for (HeldLease& held : holds_.all()) {
        const Links& asked = std::get<traffic::HoldGreen>(held.lease.action).links;
        if (!links.empty() && conflict(signal_, asked, links)) {
            LeaseQueue::refuse(held, "outranked", ledger);
            continue;
        }
        links.insert(links.end(), asked.begin(), asked.end());
    }
    std::ranges::sort(links);
    links.erase(std::unique(links.begin(), links.end()), links.end());
    return links;
}

Links SignalControl::allowed_now(core::Seconds now, const SignalTiming& timing, Ledger& ledger) {
    const bool in_program = stage_ == Stage::own_program;
    if (!in_program && (now - taken_since_).value >= timing.hold_cap_s - time_tolerance_s) capped_ = true;
    const bool cooling = in_program && now.value < cool_until_.value - time_tolerance_s;
    if (!capped_ && !cooling) return requested(ledger);
    for (HeldLease& held : holds_.all()) {
        LeaseQueue::refuse(held, capped_ ? "hold_cap" : "cool_down", ledger);
    }
    return {};
}

void SignalControl::step(const SignalSurroundings& around, Ledger& ledger,
                         std::vector<traffic::Command>& commands) {
    holds_.expire(around.now, ledger);
    favours_.expire(around.now, ledger);
    if (around.state.empty() || around.state.size() < signal_.links.size()) {
        holds_.drop_all("signal_gone", ledger);
        favours_.drop_all("signal_gone", ledger);
        stage_ = Stage::own_program;
        return;
    }
    const Links links = allowed_now(around.now, around.timing, ledger);
    if (stage_ == Stage::own_program) {
        if (links.empty()) return shorten(around, commands);
        shown_ = around.state;
        taken_since_ = around.now;
        begin_way(links, around.now, ledger, commands);
    } else if (links != links_) {
        begin_way(links, around.now, ledger, commands);
    }
    proceed(around, commands);
}

/// The phase after a green that a favour wants to end; the program itself goes on from there.
void SignalControl::shorten(const SignalSurroundings& around, std::vector<traffic::Command>& commands) {
    if (around.state != program_state_) {
        program_state_ = around.state;
        program_state_since_ = around.now;
    }
    HeldLease* const favour = favours_.best();
    if (favour == nullptr ||
        (around.now - program_state_since_).value < around.timing.least_green_s - time_tolerance_s)
        return;
    const Links& links = std::get<traffic::FavourLinks>(favour->lease.action).links;
    const auto next = phase_after_green(signal_, around.state);
    if (!next || serves_any(around.state, links)) return;
    commands.push_back(traffic::RestoreProgram{index_, next});
}

void SignalControl::begin_return(Ledger& ledger) {
    return_phase_.reset();
    if (HeldLease* favour = favours_.best()) {
        return_phase_ = best_phase(signal_, std::get<traffic::FavourLinks>(favour->lease.action).links);
        if (!return_phase_) LeaseQueue::refuse(*favour, "no_phase_serves", ledger);
    }
    target_.assign(shown_.size(), 'r');
    if (return_phase_)
        target_.replace(0, signal_.program[*return_phase_].state.size(),
                        signal_.program[*return_phase_].state);
    gaining_ = green_links(return_phase_ ? target_ : std::string(shown_.size(), 'G'));
}

void SignalControl::begin_way(const Links& links, core::Seconds now, Ledger& ledger,
                              std::vector<traffic::Command>& commands) {
    links_ = links;
    if (links.empty()) {
        begin_return(ledger);
    } else {
        target_ = hold_state(signal_, shown_, links);
        gaining_ = links;
    }
    const bool to_unknown = links.empty() && !return_phase_;
    if (needs_yellow(shown_, target_))
        enter(Stage::yellow, yellow_state(shown_, target_), now, commands);
    else if (to_unknown || needs_all_red(shown_, target_))
        enter(Stage::all_red, all_red_state(shown_, target_), now, commands);
    else
        enter(Stage::hold, target_, now, commands);
}

void SignalControl::enter(Stage stage, const std::string& state, core::Seconds now,
                          std::vector<traffic::Command>& commands) {
    if (stage_ == Stage::own_program || state != shown_)
        commands.push_back(traffic::SetSignalState{index_, state});
    stage_ = stage;
    stage_since_ = now;
    shown_ = state;
}

/// Nobody who has lost green is still on a way that those who get it will cross.
bool SignalControl::is_clear(const OccupiedLanes& occupied) const {
    const auto link_count = static_cast<std::uint16_t>(inner_lanes_.size());
    for (std::uint16_t link = 0; link < link_count; ++link) {
        const bool keeps = link < target_.size() && traffic::is_green(target_[link]);
        if (keeps || !conflict(signal_, {link}, gaining_)) continue;
        for (const core::LaneIndex lane : inner_lanes_[link]) {
            if (std::ranges::binary_search(occupied, lane)) return false;
        }
    }
    return true;
}

void SignalControl::proceed(const SignalSurroundings& around, std::vector<traffic::Command>& commands) {
    const auto is_over = [&](double duration_s) {
        return (around.now - stage_since_).value >= duration_s - time_tolerance_s;
    };
    if (stage_ == Stage::yellow && is_over(around.timing.yellow_s)) {
        const std::string red = all_red_state(shown_, target_);
        const bool to_red = (links_.empty() && !return_phase_) || needs_all_red(red, target_);
        enter(to_red ? Stage::all_red : Stage::hold, to_red ? red : target_, around.now, commands);
    }
    const bool is_cleared =
        stage_ == Stage::all_red && is_over(around.timing.all_red_s) &&
        (is_over(around.timing.all_red_s + around.timing.clearing_s) || is_clear(around.occupied));
    if (is_cleared) enter(Stage::hold, target_, around.now, commands);
    if (stage_ == Stage::hold && links_.empty()) return_to_program(around.now, around.timing, commands);
}

void SignalControl::return_to_program(core::Seconds now, const SignalTiming& timing,
                                      std::vector<traffic::Command>& commands) {
    commands.push_back(traffic::RestoreProgram{index_, return_phase_});
    program_state_.clear();
    stage_ = Stage::own_program;
    capped_ = false;
    cool_until_ = now + core::Seconds(timing.cool_down_s);
}

void SignalControl::restore(std::vector<traffic::Command>& commands) {
    holds_.clear();
    favours_.clear();
    if (stage_ != Stage::own_program) commands.push_back(traffic::RestoreProgram{index_});
    stage_ = Stage::own_program;
    capped_ = false;
}

}  // namespace clearway::actuation::detail
