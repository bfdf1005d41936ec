#include "policy/detail/hold_planner.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace clearway::policy::detail {
namespace {

/// Emergency vehicles count as unhindered until they have driven this long, s.
constexpr double pace_prior_s = 20.0;
/// Slower ones stand in a queue, which the model knows of, m/s.
constexpr float driving_mps = 1.0F;
/// Between two decisions about the same request.
constexpr core::Seconds longest_gap{1.0};

/// Later beginnings that are considered, s from now: finer where they come soon.
constexpr std::array later_s{2.0, 4.0, 6.0, 9.0, 12.0, 16.0, 20.0, 25.0, 30.0, 36.0, 42.0, 50.0};

}  // namespace

void Pace::watch(const RequestKey& request, double free_s, core::Seconds now, bool drives_on_green) {
    const auto [last, is_first] = last_.try_emplace(request, Moment{free_s, now});
    const core::Seconds since = now - last->second.time;
    if (!is_first && drives_on_green && since <= longest_gap) {
        covered_s_ += std::max(0.0, last->second.free_s - free_s);
        spent_s_ += since.value;
    }
    last->second = {free_s, now};
}

double Pace::share() const {
    constexpr double least = 0.3;
    return std::clamp((pace_prior_s + covered_s_) / (pace_prior_s + spent_s_), least, 1.0);
}

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
    if (here.controller == "NEMA" || !edge) return is_held || rule_s <= 0.0;
    const traffic::BelievedVehicle& emergency = arrival.emergency;
    const double open_road_s = free_s_to(view, arrival);
    if (arrival.moved_m <= 0.0)
        pace_.watch({emergency.key, signal}, open_road_s, view.belief().time,
                    is_held && emergency.state.speed_mps > driving_mps);
    const double free_s = open_road_s / pace_.share();
    const auto [reached, is_first] = reached_.try_emplace(emergency.key);
    const double not_before_s = is_first ? 0.0 : reached->second.time_s + free_s - reached->second.free_s;
    const double cycle_time_s = clocks_[signal.value].cycle_time_s(here, view.belief().time);
    const QueueModel model(view, arrival,
                           SignalForecaster(here, arrival.approach.links,
                                            view.belief().signals.state[signal.value], cycle_time_s),
                           {*edge, not_before_s, settings_.emergency_worth, settings_.sight, pace_.share()},
                           workspace_);
    const auto cost = [&](const QueueModel::Outcome& outcome) {
        return settings_.emergency_worth * outcome.passing_s + outcome.waited_s;
    };
    const QueueModel::Outcome held_now = model.outcome(0.0);
    QueueModel::Outcome best = held_now;
    const bool is_late = rule_s <= 0.0;
    bool is_due = rule_s <= settings_.longest_early_s;
    if (!is_held) {
        const auto consider = [&](std::optional<double> start_s) {
            // Whoever passes later costs more, whatever the others wait.
            constexpr double rounding = 1.0 + 1e-9;
            const double latest_s = settings_.emergency_worth > 0.0
                                        ? cost(best) / settings_.emergency_worth * rounding
                                        : QueueModel::never_s;
            const std::optional<QueueModel::Outcome> other = model.outcome(start_s, latest_s);
            if (!other || cost(*other) > cost(best)) return;
            best = *other;
            is_due = false;
        };
        std::ranges::for_each(later_s, consider);
        consider(std::nullopt);
    }
    if (!is_late) {
        const double by_rule_s = model.outcome(std::min(rule_s, later_s.back())).passing_s;
        is_due = is_due && by_rule_s - held_now.passing_s >= settings_.least_gain_s;
    }
    is_due = is_due || is_held || (is_late && -rule_s >= settings_.longest_late_s);
    reached->second = {free_s, best.passing_s};
    return is_due;
}

}  // namespace clearway::policy::detail
