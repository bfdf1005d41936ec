#include "policy/detail/lane_plan.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace clearway::policy::detail {
namespace {

constexpr double slowest_limit_mps = 1.0;

std::size_t cell_of(double distance_m) {
    return static_cast<std::size_t>(std::max(0.0, distance_m) / plan_cell_m);
}

}  // namespace

LanePlan::LanePlan(const PlanScene& scene, const LanePlanConfig& config, double horizon_m) {
    find_columns(scene.view, scene.emergency, horizon_m);
    assert(own_ < numbers_.size());
    plan_.resize(cell_of(horizon_m) + 1, own_);
    choose(costs(scene, config), config.change_s);
}

void LanePlan::find_columns(const View& view, const traffic::BelievedVehicle& emergency, double horizon_m) {
    const roads::Lane& lane = view.network().lane(emergency.state.lane);
    const roads::Edge& edge = view.network().edge(lane.edge);
    const roads::Route route = view.route_of(emergency.key);
    std::vector<roads::RouteStep> steps;
    numbers_.reserve(edge.lane_count);
    for (std::uint32_t number = 0; number < edge.lane_count; ++number) {
        const bool is_own = number == lane.number;
        if (!is_own && (edge.internal || !view.may_use_lane(emergency, number))) continue;
        if (is_own) own_ = numbers_.size();
        traffic::MotionState start = emergency.state;
        start.lane = edge.internal ? emergency.state.lane : view.network().lane_of(lane.edge, number);
        roads::lanes_ahead(view.network(), route, start, core::Metres(horizon_m), steps);
        rows_.reserve(steps.size() * edge.lane_count);
        for (const roads::RouteStep& step : steps)
            rows_.emplace_back(step.lane, numbers_.size());
        numbers_.push_back(number);
    }
    std::ranges::sort(rows_);
}

std::optional<std::size_t> LanePlan::row_of(core::LaneIndex lane) const {
    const auto found = std::ranges::lower_bound(rows_, std::pair(lane, std::size_t{0}));
    if (found == rows_.end() || found->first != lane) return std::nullopt;
    return found->second;
}

std::vector<double> LanePlan::costs(const PlanScene& scene, const LanePlanConfig& config) const {
    std::vector<double> cost(plan_.size() * numbers_.size(), 0.0);
    const double free_mps = std::max(scene.view.allowed_speed(scene.emergency).value, slowest_limit_mps);
    for (const VehicleAhead& other : scene.ahead) {
        const auto column = row_of(other.vehicle->state.lane);
        const std::size_t cell = cell_of(other.distance_m);
        if (!column || cell >= plan_.size()) continue;
        const double speed_mps = other.vehicle->state.speed_mps;
        double delay_s = config.slow_s * std::max(0.0, 1.0 - speed_mps / free_mps);
        if (speed_mps < config.halted_mps) delay_s = config.blocked_s;
        cost[at(cell, *column)] +=
            scene.audience.has(*other.vehicle) ? std::min(config.clears_s, delay_s) : delay_s;
    }
    return cost;
}

/// From the far end back: the least delay from each cell and column on.
void LanePlan::choose(const std::vector<double>& cost, double change_s) {
    const std::size_t columns = numbers_.size();
    assert(cost.size() == plan_.size() * columns);
    std::vector<double> rest(cost.size() + columns, 0.0);
    std::vector<std::size_t> next(cost.size(), 0);
    for (std::size_t cell = plan_.size(); cell-- > 0;) {
        for (std::size_t from = 0; from < columns; ++from) {
            double best = std::numeric_limits<double>::infinity();
            for (const std::size_t to : {from, from - 1, from + 1}) {
                if (to >= columns) continue;  // from - 1 wraps round
                const double total =
                    (to == from ? 0.0 : change_s) + cost[at(cell, to)] + rest[at(cell + 1, to)];
                if (total >= best) continue;
                best = total;
                next[at(cell, from)] = to;
            }
            rest[at(cell, from)] = best;
        }
    }
    std::size_t column = own_;
    for (std::size_t cell = 0; cell < plan_.size(); ++cell) {
        column = next[at(cell, column)];
        plan_[cell] = column;
    }
}

std::optional<std::uint32_t> LanePlan::column_at(double distance_m) const {
    const std::size_t cell = cell_of(distance_m);
    if (cell >= plan_.size()) return std::nullopt;
    return numbers_[plan_[cell]];
}

std::optional<std::uint32_t> LanePlan::column_of(core::LaneIndex lane) const {
    const auto row = row_of(lane);
    return row ? std::optional(numbers_[*row]) : std::nullopt;
}

std::optional<std::uint32_t> LanePlan::change_within(double distance_m) const {
    const std::size_t last = std::min(cell_of(distance_m), plan_.size() - 1);
    for (std::size_t cell = 0; cell <= last; ++cell) {
        if (plan_[cell] != own_) return numbers_[plan_[cell]];
    }
    return std::nullopt;
}

void follow(const LanePlan& plan, const traffic::BelievedVehicle& emergency, double change_ahead_s,
            LeaseWriter& write) {
    const double look_m = std::max<double>(2.0 * plan_cell_m, change_ahead_s * emergency.state.speed_mps);
    if (const auto lane = plan.change_within(look_m))
        write.add(emergency.key, traffic::ChangeLane{*lane}, "the way that is being cleared", emergency.key);
}

}  // namespace clearway::policy::detail
