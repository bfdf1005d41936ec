#include "actuation/detail/background_plan.hpp"

#include <algorithm>
#include <cmath>

#include "actuation/detail/lease_queue.hpp"
#include "actuation/detail/signal_states.hpp"

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

double BackgroundPlan::least_s(std::uint32_t phase, core::Seconds least_green) const {
    return std::max(least_green.value, signal_.program[phase].least_s);
}

double BackgroundPlan::lag_s(std::uint32_t phase, core::Seconds now) const {
    double starts_s = signal_.offset_s;
    for (std::uint32_t row = 0; row < phase; ++row)
        starts_s += signal_.program[row].duration_s;
    return std::remainder(starts_s - now.value, cycle_s_);
}

}  // namespace clearway::actuation::detail
