#include "actuation/detail/signal_control.hpp"

#include <algorithm>

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
        if (links.empty()) return;
        shown_ = around.state;
        taken_since_ = around.now;
        begin_way(links, around.now, commands);
    } else if (links != links_) {
        begin_way(links, around.now, commands);
    }
    proceed(around, ledger, commands);
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

/// Nobody who has lost green is still on a way that those who get it will cross.
bool SignalControl::is_clear(const OccupiedLanes& occupied) const {
    const auto link_count = static_cast<std::uint16_t>(inner_lanes_.size());
    for (std::uint16_t link = 0; link < link_count; ++link) {
        const bool is_served = std::ranges::binary_search(links_, link);
        if (is_served || (!links_.empty() && !conflict(signal_, {link}, links_))) continue;
        for (const core::LaneIndex lane : inner_lanes_[link]) {
            if (std::ranges::binary_search(occupied, lane)) return false;
        }
    }
    return true;
}

void SignalControl::proceed(const SignalSurroundings& around, Ledger& ledger,
                            std::vector<traffic::Command>& commands) {
    const auto is_over = [&](double duration_s) {
        return (around.now - stage_since_).value >= duration_s - time_tolerance_s;
    };
    if (stage_ == Stage::yellow && is_over(around.timing.yellow_s)) {
        const std::string red = all_red_state(shown_, target_);
        const bool to_red = links_.empty() || needs_all_red(red, target_);
        enter(to_red ? Stage::all_red : Stage::hold, to_red ? red : target_, around.now, commands);
    }
    if (stage_ != Stage::all_red || !is_over(around.timing.all_red_s)) return;
    if (!is_over(around.timing.all_red_s + around.timing.clearing_s) && !is_clear(around.occupied)) return;
    if (links_.empty())
        return_to_program(around.now, around.timing, ledger, commands);
    else
        enter(Stage::hold, target_, around.now, commands);
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
