#include "actuation/detail/signal_control.hpp"

#include <algorithm>

namespace clearway::actuation::detail {

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
    const auto repeated = std::ranges::unique(links);
    links.erase(repeated.begin(), repeated.end());
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

void SignalControl::step(core::Seconds now, const std::string& state, const SignalTiming& timing,
                         Ledger& ledger, std::vector<traffic::Command>& commands) {
    holds_.expire(now, ledger);
    favours_.expire(now, ledger);
    if (state.empty() || state.size() < signal_.links.size()) {
        holds_.drop_all("signal_gone", ledger);
        favours_.drop_all("signal_gone", ledger);
        stage_ = Stage::own_program;
        return;
    }
    const Links links = allowed_now(now, timing, ledger);
    if (stage_ == Stage::own_program) {
        if (links.empty()) return;
        shown_ = state;
        taken_since_ = now;
        begin_way(links, now, commands);
    } else if (links != links_) {
        begin_way(links, now, commands);
    }
    proceed(now, timing, ledger, commands);
}

void SignalControl::begin_way(const Links& links, core::Seconds now,
                              std::vector<traffic::Command>& commands) {
    links_ = links;
    target_ = links.empty() ? std::string(shown_.size(), 'r') : hold_state(signal_, shown_, links);
    if (needs_yellow(shown_, target_))
        enter(Stage::yellow, yellow_state(shown_, target_), now, commands);
    else if (links.empty() || needs_all_red(shown_, target_))
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

void SignalControl::proceed(core::Seconds now, const SignalTiming& timing, Ledger& ledger,
                            std::vector<traffic::Command>& commands) {
    const auto is_over = [&](double duration_s) {
        return (now - stage_since_).value >= duration_s - time_tolerance_s;
    };
    if (stage_ == Stage::yellow && is_over(timing.yellow_s)) {
        const bool to_red = links_.empty() || needs_all_red(all_red_state(shown_, target_), target_);
        if (to_red)
            enter(Stage::all_red, all_red_state(shown_, target_), now, commands);
        else
            enter(Stage::hold, target_, now, commands);
    }
    if (stage_ != Stage::all_red || !is_over(timing.all_red_s)) return;
    if (links_.empty())
        return_to_program(now, timing, ledger, commands);
    else
        enter(Stage::hold, target_, now, commands);
}

void SignalControl::return_to_program(core::Seconds now, const SignalTiming& timing, Ledger& ledger,
                                      std::vector<traffic::Command>& commands) {
    std::optional<std::uint32_t> phase;
    if (HeldLease* favour = favours_.best()) {
        phase = best_phase(signal_, std::get<traffic::FavourLinks>(favour->lease.action).links);
        if (!phase) LeaseQueue::refuse(*favour, "no_phase_serves", ledger);
    }
    commands.push_back(traffic::RestoreProgram{index_, phase});
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
