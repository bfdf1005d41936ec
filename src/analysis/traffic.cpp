#include "analysis/traffic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <span>

namespace clearway::analysis {
namespace {

using detail::Runs;
using Pair = std::pair<const results::RunRecord*, const results::RunRecord*>;  // condition, baseline

/// Replications in which both runs are complete and record where time was lost.
std::vector<Pair> watched_pairs(const Runs& condition, const Runs& baseline) {
    std::vector<Pair> pairs;
    for (std::size_t replication = 0; replication < std::min(condition.size(), baseline.size());
         ++replication) {
        const Pair pair{condition[replication], baseline[replication]};
        if (pair.first == nullptr || pair.second == nullptr) continue;
        if (!pair.first->traffic.approaches.empty() && !pair.second->traffic.approaches.empty())
            pairs.push_back(pair);
    }
    return pairs;
}

/// Numbers of one approach, one value per pair; index 0 is the condition, 1 the baseline.
struct Series {
    explicit Series(std::size_t pairs) {
        for (auto* const column : {&human, &automated, &waiting, &vehicles}) {
            for (std::vector<double>& values : *column)
                values.assign(pairs, 0.0);
        }
    }
    std::array<std::vector<double>, 2> human, automated, waiting, vehicles;
};

void collect(const results::RunRecord& run, std::size_t side, std::size_t pair, std::size_t pairs,
             std::map<std::string, Series>& series) {
    for (const metrics::ApproachRow& row : run.traffic.approaches) {
        Series& one = series.try_emplace(row.edge, pairs).first->second;
        const bool automated = row.vehicle_class == traffic::VehicleClass::automated;
        (automated ? one.automated : one.human)[side][pair] += row.time_loss_s;
        one.waiting[side][pair] += row.waiting_time_s;
        one.vehicles[side][pair] += static_cast<double>(row.vehicles);
    }
}

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> sum_of(const std::vector<double>& first, const std::vector<double>& second) {
    std::vector<double> sum(first.size());
    std::ranges::transform(first, second, sum.begin(), std::plus<>());
    return sum;
}

ApproachCost cost_of(const std::string& edge, const Series& series, double level) {
    ApproachCost cost;
    const std::vector<double> condition = sum_of(series.human[0], series.automated[0]);
    const std::vector<double> baseline = sum_of(series.human[1], series.automated[1]);
    cost.edge = edge;
    cost.baseline_s = mean_of(baseline);
    cost.difference = estimate_difference(condition, baseline, level);
    cost.t_p = paired_t_p(condition, baseline);
    cost.human = estimate_difference(series.human[0], series.human[1], level);
    cost.automated = estimate_difference(series.automated[0], series.automated[1], level);
    cost.waiting = estimate_difference(series.waiting[0], series.waiting[1], level);
    cost.vehicles = mean_of(series.vehicles[1]);
    if (*cost.vehicles > 0.0) cost.per_vehicle_s = cost.difference->mean / *cost.vehicles;
    return cost;
}

using Stretch = std::span<const RecoveryPoint>;

/// The stretches of `recovered_for_s` after the EV.
std::vector<Stretch> stretches_of(const std::vector<RecoveryPoint>& points) {
    std::vector<Stretch> stretches;
    for (auto first = points.begin(); first != points.end(); ++first) {
        const auto last = std::find_if(first, points.end(), [&](const RecoveryPoint& point) {
            return point.offset_s >= first->offset_s + recovered_for_s;
        });
        if (first->offset_s >= 0.0 && last != points.end()) stretches.emplace_back(first, last + 1);
    }
    return stretches;
}

bool is_recovered(const RecoveryPoint& point) {
    const Interval* const interval = shown_interval(point.difference);
    return interval != nullptr && interval->high < recovered_within_vehicles;
}

bool is_longer(const RecoveryPoint& point) {
    const Interval* const interval = shown_interval(point.difference);
    return interval != nullptr && interval->low > recovered_within_vehicles;
}

/// Nothing where a mean is not below the limit, or there is no interval.
std::optional<std::size_t> pairs_to_tell(Stretch stretch, double level) {
    std::size_t pairs = 0;
    for (const RecoveryPoint& point : stretch) {
        const double room = recovered_within_vehicles - mean_of(point.difference).value_or(0.0);
        if (room <= 0.0 || shown_interval(point.difference) == nullptr) return std::nullopt;
        pairs = std::max(pairs, required_replications(point.difference->deviation, room, level));
    }
    return pairs;
}

/// Fills in what the points tell.
void judge(Recovery& recovery, double level) {
    const std::vector<Stretch> stretches = stretches_of(recovery.points);
    const auto recovered = std::ranges::find_if(
        stretches, [](Stretch stretch) { return std::ranges::all_of(stretch, is_recovered); });
    if (recovered != stretches.end()) {
        recovery.recovered_by_s = recovered->front().offset_s;
        return;
    }
    recovery.stays_longer = !stretches.empty() && std::ranges::all_of(stretches, [](Stretch stretch) {
        return std::ranges::any_of(stretch, is_longer);
    });
    for (const Stretch stretch : stretches) {
        const auto pairs = pairs_to_tell(stretch, level);
        if (pairs) recovery.pairs_to_tell = std::min(*pairs, recovery.pairs_to_tell.value_or(*pairs));
    }
}

}  // namespace

std::vector<ApproachCost> approach_costs(const Runs& condition, const Runs& baseline, double level) {
    const std::vector<Pair> pairs = watched_pairs(condition, baseline);
    std::map<std::string, Series> series;
    for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
        collect(*pairs[pair].first, 0, pair, pairs.size(), series);
        collect(*pairs[pair].second, 1, pair, pairs.size(), series);
    }
    std::vector<ApproachCost> costs;
    for (const auto& [edge, one] : series)
        costs.push_back(cost_of(edge, one, level));
    std::ranges::stable_sort(costs, std::greater<>(),
                             [](const ApproachCost& cost) { return std::abs(cost.difference->mean); });
    return costs;
}

std::optional<Recovery> recovery_after(const Runs& condition, const Runs& baseline, double level) {
    std::map<double, detail::Pairs> at_offset;
    for (const auto& [with, without] : watched_pairs(condition, baseline)) {
        std::map<double, double> before;
        for (const metrics::RecoveryRow& row : without->traffic.recovery)
            before[row.offset_s] = row.halted_vehicles;
        for (const metrics::RecoveryRow& row : with->traffic.recovery) {
            const auto found = before.find(row.offset_s);
            if (found != before.end()) at_offset[row.offset_s].add(row.halted_vehicles, found->second);
        }
    }
    if (at_offset.empty()) return std::nullopt;
    Recovery recovery;
    for (const auto& [offset_s, values] : at_offset)
        recovery.points.push_back({offset_s, estimate_difference(values.condition, values.baseline, level)});
    judge(recovery, level);
    return recovery;
}

}  // namespace clearway::analysis
