#include "policy/detail/signal_forecast.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "traffic/signal.hpp"

namespace clearway::policy::detail {
namespace {

/// From the end of a green to the one of a link that conflicts, s: the shortest yellow (3 s), and 2 s of red.
constexpr double transition_s = 5.0;

/// The time within a cycle that lasts `cycle_s`, s.
double within(double time_s, double cycle_s) {
    return std::fmod(std::fmod(time_s, cycle_s) + cycle_s, cycle_s);
}

/// The phase that runs at a time of the cycle, and for how long yet.
std::pair<std::size_t, double> phase_at(const roads::Signal& signal, double cycle_time_s) {
    std::size_t row = 0;
    while (row + 1 < signal.program.size() && cycle_time_s >= signal.program[row].duration_s)
        cycle_time_s -= signal.program[row++].duration_s;
    return {row, signal.program[row].duration_s - cycle_time_s};
}

/// Sets what is shown between two states: links that are green in both stay so. Returns whether one loses
/// green.
bool set_between(std::string_view before, std::string_view after, std::string& state) {
    state.assign(before.size(), 'r');
    bool loses = false;
    for (std::size_t link = 0; link < before.size(); ++link) {
        if (traffic::is_red(before[link])) continue;
        const bool goes_on = traffic::is_green_for(after, link);
        loses = loses || !goes_on;
        if (goes_on && traffic::is_green(before[link])) state[link] = before[link];
    }
    return loses;
}

}  // namespace

void ProgramClock::watch(const std::string& shown, core::Seconds now) {
    if (shown == shown_) return;
    shown_ = shown;
    since_ = now;
}

double ProgramClock::cycle_time_s(const roads::Signal& signal, core::Seconds now) const {
    const double cycle_s = signal.cycle_s();
    if (cycle_s <= 0.0) return 0.0;
    const double in_step_s = within(now.value - signal.offset_s, cycle_s);
    if (signal.fixed_time && signal.program[phase_at(signal, in_step_s).first].state == shown_)
        return in_step_s;
    double found_s = in_step_s;
    double nearest_s = cycle_s;
    double begins_s = 0.0;
    for (const roads::Phase& phase : signal.program) {
        const double last_s =
            std::max(0.0, phase.duration_s - 1.0);  // it may be about to end, but shows it yet
        const double here_s = begins_s + std::min((now - since_).value, last_s);
        const double off_s = std::abs(std::remainder(here_s - in_step_s, cycle_s));
        if (phase.state == shown_ && off_s < nearest_s) {
            nearest_s = off_s;
            found_s = here_s;
        }
        begins_s += phase.duration_s;
    }
    return found_s;
}

SignalForecaster::SignalForecaster(const roads::Signal& signal, std::span<const std::uint16_t> held,
                                   std::string_view shown, double cycle_time_s)
    : signal_(signal), held_(held), shown_(shown), cycle_time_s_(cycle_time_s), cycle_s_(signal.cycle_s()) {}

void SignalForecaster::run(double from_s, double to_s, SignalForecast& forecast) const {
    if (cycle_s_ <= 0.0) return;
    constexpr double shortest_s = 0.1;  // a phase of 0 s would never end
    auto [row, left_s] = phase_at(signal_, within(cycle_time_s_ + from_s, cycle_s_));
    while (from_s < to_s) {
        const double ends_s = std::min(to_s, from_s + std::max(left_s, shortest_s));
        forecast.pieces.push_back({from_s, ends_s, signal_.program[row].state});
        row = (row + 1) % signal_.program.size();
        left_s = signal_.program[row].duration_s;
        from_s = ends_s;
    }
}

std::string_view SignalForecaster::shown_at(double time_s) const {
    if (cycle_s_ <= 0.0) return {};
    return signal_.program[phase_at(signal_, within(cycle_time_s_ + time_s, cycle_s_)).first].state;
}

/// Green for the held links, and for those that conflict with none of them in the phase that serves most.
void SignalForecaster::set_held(std::size_t letters, std::string& state) const {
    const auto served = [&](const roads::Phase& phase) {
        return std::ranges::count_if(
            held_, [&](std::uint16_t link) { return traffic::is_green_for(phase.state, link); });
    };
    state.assign(letters, 'r');
    const auto best = std::ranges::max_element(signal_.program, {}, served);
    if (best != signal_.program.end() && served(*best) > 0)
        for (std::size_t link = 0; link < std::min(letters, signal_.links.size()); ++link) {
            const bool conflicts =
                std::ranges::any_of(held_, [&](std::uint16_t held) { return signal_.foes[link][held]; });
            if (!conflicts && traffic::is_green_for(best->state, link)) state[link] = best->state[link];
        }
    for (const std::uint16_t link : held_)
        if (link < letters) state[link] = 'G';
}

void SignalForecaster::program(double until_s, SignalForecast& forecast) const {
    forecast.pieces.clear();
    run(0.0, until_s, forecast);
}

void SignalForecaster::hold(double start_s, double until_s, SignalForecast& forecast) const {
    assert(start_s >= 0.0 && start_s + transition_s < until_s);
    forecast.pieces.clear();
    run(0.0, start_s, forecast);
    const std::string_view before = start_s > 0.0 || shown_.empty() ? shown_at(start_s) : shown_;
    const std::size_t letters = before.empty() ? signal_.links.size() : before.size();
    if (forecast.held.size() != letters) set_held(letters, forecast.held);
    double opens_s = start_s;
    if (set_between(before, forecast.held, forecast.before)) {
        opens_s = start_s + transition_s;
        forecast.pieces.push_back({start_s, opens_s, forecast.before});
    }
    forecast.pieces.push_back({opens_s, until_s, forecast.held});
}

void SignalForecaster::release(SignalForecast& forecast, double at_s, double until_s) const {
    ShownPiece& held = forecast.pieces.back();
    const double ends_s = std::clamp(at_s, held.from_s, until_s);
    held.to_s = ends_s;
    if (ends_s >= until_s) return;
    double back_s = ends_s;
    if (set_between(held.state, shown_at(ends_s + transition_s), forecast.after)) {
        back_s = std::min(until_s, ends_s + transition_s);
        forecast.pieces.push_back({ends_s, back_s, forecast.after});
    }
    run(back_s, until_s, forecast);
}

}  // namespace clearway::policy::detail
