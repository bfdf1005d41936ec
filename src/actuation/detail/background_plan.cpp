#include "actuation/detail/background_plan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "actuation/detail/lease_queue.hpp"
#include "actuation/detail/signal_states.hpp"
#include "traffic/signal.hpp"

namespace clearway::actuation::detail {
namespace {

/// A green is extended by at most this share to get back into step, because others wait for it.
constexpr double most_stretch = 0.5;
/// A program that is not back in step after so many cycles has no green that is unique among its phases.
constexpr double most_cycles = 5.0;
/// A smaller offset counts as in step, s: a state is seen one simulated step after it began.
constexpr double in_step_s = 1.0;

/// Signals farther apart than this are not coordinated, m.
constexpr double neighbour_m = 800.0;

/// From the start of a phase in which a link is green until it loses green, s; at most one cycle.
double green_from_s(const roads::Signal& signal, std::uint16_t link, std::uint32_t phase) {
    assert(phase < signal.program.size());
    double green_s = 0.0;
    const std::size_t rows = signal.program.size();
    for (std::size_t row = phase;
         row < phase + rows && traffic::is_green_for(signal.program[row % rows].state, link); ++row)
        green_s += signal.program[row % rows].duration_s;
    return green_s;
}

/// The whole green of a link to which a phase belongs, s; at most one cycle.
double whole_green_s(const roads::Signal& signal, std::uint16_t link, std::uint32_t phase) {
    const auto rows = static_cast<std::uint32_t>(signal.program.size());
    std::uint32_t first = phase;
    for (std::uint32_t back = 1; back < rows; ++back) {
        const std::uint32_t row = (phase + rows - back) % rows;
        if (!traffic::is_green_for(signal.program[row].state, link)) break;
        first = row;
    }
    return green_from_s(signal, link, first);
}

/// Where the first lane that a signal controls ends.
std::optional<roads::Point> place_of(const roads::Signal& signal, const roads::Network& network) {
    for (const auto& ways : signal.links)
        if (!ways.empty()) return network.lane(ways.front().from).shape.back();
    return std::nullopt;
}

}  // namespace

bool keeps_step(core::SignalIndex signal, const roads::Network& network) {
    const auto here = place_of(network.signal(signal), network);
    if (!here || !network.signal(signal).fixed_time) return false;
    return std::ranges::any_of(network.signals(), [&](const roads::Signal& other) {
        const auto there = &other == &network.signal(signal) ? std::nullopt : place_of(other, network);
        return there && std::hypot(there->x_m - here->x_m, there->y_m - here->y_m) <= neighbour_m;
    });
}

BackgroundPlan::BackgroundPlan(const roads::Signal& signal, bool keeps_step)
    : signal_(signal), keeps_step_(keeps_step) {
    for (const roads::Phase& phase : signal.program)
        cycle_s_ += phase.duration_s;
}

void BackgroundPlan::leave() {
    left_ = std::exchange(state_, {});
}

void BackgroundPlan::watch(const std::string& state, core::Seconds now) {
    const bool is_new = state != state_;
    just_changed_ = is_new && !state_.empty();  // at first sight it is unknown since when the state is shown
    if (!is_new) return;
    state_ = state;
    since_ = now;
}

void BackgroundPlan::disturb(core::Seconds now) {
    in_step_ = !keeps_step_ || cycle_s_ <= 0.0;
    disturbed_ = now;
}

bool BackgroundPlan::is_in_step(core::Seconds now) const {
    return in_step_ || (now - disturbed_).value > most_cycles * cycle_s_;
}

std::optional<std::uint32_t> BackgroundPlan::next_after(core::Seconds least_green, core::Seconds now) const {
    const auto phase = green_phase(signal_, state_);
    if (!phase || (now - since_).value < least_s(*phase, least_green) - time_tolerance_s) return std::nullopt;
    return (*phase + 1) % static_cast<std::uint32_t>(signal_.program.size());
}

std::optional<PhaseChange> BackgroundPlan::step_back(core::Seconds least_green, core::Seconds now) {
    if (in_step_ || !just_changed_) return std::nullopt;
    const auto phase = green_phase(signal_, state_);
    if (!phase) return std::nullopt;
    const double lag_s = this->lag_s(*phase, now);
    in_step_ = std::abs(lag_s) <= in_step_s;
    if (in_step_) return std::nullopt;
    const double own_s = signal_.program[*phase].duration_s;
    const double lasting_s = std::clamp(own_s + lag_s, std::min(own_s, least_s(*phase, least_green)),
                                        own_s * (1.0 + most_stretch));
    return PhaseChange{*phase, core::Seconds(lasting_s)};
}

bool BackgroundPlan::pays_greens(std::uint32_t phase, double since_s, const OwedGreen& owed_s) const {
    const std::string& state = signal_.program[phase].state;
    if (std::ranges::any_of(state, traffic::is_yellow) || std::ranges::none_of(state, traffic::is_green))
        return false;
    return std::ranges::all_of(green_links(state), [&](std::uint16_t link) {
        if (link >= signal_.links.size()) return true;
        const double least_s = std::min(owed_s(link, phase), whole_green_s(signal_, link, phase));
        return green_from_s(signal_, link, phase) - since_s >= least_s - time_tolerance_s;
    });
}

std::optional<std::uint32_t> BackgroundPlan::resume(const OwedGreen& owed_s, core::Seconds least_rest,
                                                    core::Seconds now) const {
    const auto rows = static_cast<std::uint32_t>(signal_.program.size());
    if (cycle_s_ <= 0.0) return std::nullopt;
    std::uint32_t phase = 0;
    double since_s = 0.0;
    if (signal_.fixed_time) {
        since_s = std::fmod(std::fmod(now.value - signal_.offset_s, cycle_s_) + cycle_s_, cycle_s_);
        while (phase + 1 < rows && since_s >= signal_.program[phase].duration_s)
            since_s -= signal_.program[phase++].duration_s;
    } else {
        const auto left = std::ranges::find(signal_.program, left_, &roads::Phase::state);
        if (left == signal_.program.end()) return std::nullopt;
        phase = static_cast<std::uint32_t>(left - signal_.program.begin() + 1) % rows;
    }
    for (std::uint32_t tried = 0; tried <= rows; ++tried, since_s = 0.0) {
        const std::uint32_t row = (phase + tried) % rows;
        const bool lasts = since_s <= 0.0 || signal_.program[row].duration_s - since_s >= least_rest.value;
        if (lasts && pays_greens(row, since_s, owed_s)) return row;
    }
    return std::nullopt;
}

double BackgroundPlan::resumed_s(std::uint32_t phase, const OwedGreen& owed_s, core::Seconds least_rest,
                                 core::Seconds now) const {
    const double own_s = signal_.program[phase].duration_s;
    const double lag_s = this->lag_s(phase, now);
    const double left_s = own_s + lag_s;
    const bool lasts = lag_s >= 0.0 || left_s >= least_rest.value;
    if (!lasts || !pays_greens(phase, std::max(0.0, -lag_s), owed_s)) return own_s;
    return std::min(left_s, own_s * (1.0 + most_stretch));
}

double BackgroundPlan::least_s(std::uint32_t phase, core::Seconds least_green) const {
    return std::max(least_green.value, signal_.program[phase].least_s);
}

double BackgroundPlan::lag_s(std::uint32_t phase, core::Seconds now) const {
    assert(phase < signal_.program.size() && cycle_s_ > 0.0);
    double starts_s = signal_.offset_s;
    for (std::uint32_t row = 0; row < phase; ++row)
        starts_s += signal_.program[row].duration_s;
    return std::remainder(starts_s - now.value, cycle_s_);
}

}  // namespace clearway::actuation::detail
