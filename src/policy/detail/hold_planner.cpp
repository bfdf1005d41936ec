#include "policy/detail/hold_planner.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace clearway::policy::detail {
namespace {

/// Later beginnings that are considered, s from now: finer where they come soon.
constexpr std::array later_s{2.0, 4.0, 6.0, 9.0, 12.0, 16.0, 20.0, 25.0, 30.0, 36.0, 42.0, 50.0};

}  // namespace

void HoldPlanner::begin(const View& view) {
    reached_.clear();
    const std::vector<std::string>& shown = view.belief().signals.state;
    clocks_.resize(shown.size());
    for (std::size_t signal = 0; signal < shown.size(); ++signal)
        clocks_[signal].watch(shown[signal], view.belief().time);
}

bool HoldPlanner::is_due(const View& view, const Arrival& arrival, double rule_s, bool is_held) {
    const core::SignalIndex signal = arrival.approach.signal;
    const roads::Signal& here = view.network().signal(signal);
    const auto edge = edge_before(view, arrival);
    if (here.controller == "NEMA" || !edge) return is_held;
    const double free_s = free_s_to(view, arrival);
    const auto [reached, is_first] = reached_.try_emplace(arrival.emergency.key);
    const double not_before_s = is_first ? 0.0 : reached->second.time_s + free_s - reached->second.free_s;
    const double cycle_time_s = clocks_[signal.value].cycle_time_s(here, view.belief().time);
    const QueueModel model(view, arrival,
                           SignalForecaster(here, arrival.approach.links,
                                            view.belief().signals.state[signal.value], cycle_time_s),
                           {*edge, not_before_s, settings_.emergency_worth, settings_.sight});
    const auto cost = [&](const QueueModel::Outcome& outcome) {
        return settings_.emergency_worth * outcome.passing_s + outcome.waited_s;
    };
    const QueueModel::Outcome held_now = model.outcome(0.0);
    QueueModel::Outcome best = held_now;
    bool is_due = true;
    if (!is_held) {
        const auto consider = [&](std::optional<double> start_s) {
            const QueueModel::Outcome other = model.outcome(start_s);
            if (cost(other) > cost(best)) return;
            best = other;
            is_due = false;
        };
        std::ranges::for_each(later_s, consider);
        consider(std::nullopt);
        const double by_rule_s = model.outcome(std::clamp(rule_s, 0.0, later_s.back())).passing_s;
        is_due = is_due && by_rule_s - held_now.passing_s >= settings_.least_gain_s;
    }
    reached->second = {free_s, best.passing_s};
    return is_due;
}

}  // namespace clearway::policy::detail
