#include "analysis/response.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace clearway::analysis {
namespace {

using Trips = std::vector<std::vector<double>>;  ///< By replication.

bool arrived(const metrics::VehicleRow& vehicle) {
    return vehicle.outcome == metrics::VehicleOutcome::arrived && vehicle.travel_time_s;
}

/// A trip, how often its replication was drawn.
struct Weighted {
    double time_s = 0.0;
    std::size_t replication = 0;
};

/// All trips, the fastest first.
std::vector<Weighted> ranked(const Trips& trips) {
    std::vector<Weighted> all;
    for (std::size_t replication = 0; replication < trips.size(); ++replication)
        for (const double time_s : trips[replication])
            all.push_back({time_s, replication});
    std::ranges::sort(all, {}, &Weighted::time_s);
    return all;
}

std::size_t drawn(const std::vector<Weighted>& all, RowCounts counts) {
    std::size_t sum = 0;
    for (const Weighted& trip : all)
        sum += counts[trip.replication];
    return sum;
}

/// The smallest time that nine in ten trips do not exceed.
double percentile_90_s(const std::vector<Weighted>& all, RowCounts counts) {
    const double wanted = 0.9 * static_cast<double>(drawn(all, counts));
    std::size_t sum = 0;
    for (const Weighted& trip : all) {
        sum += counts[trip.replication];
        if (static_cast<double>(sum) >= wanted - 1e-9) return trip.time_s;
    }
    return std::nan("");
}

double share_in_time(const std::vector<Weighted>& all, RowCounts counts, double threshold_s) {
    std::size_t sum = 0;
    for (const Weighted& trip : all)
        if (trip.time_s <= threshold_s) sum += counts[trip.replication];
    return static_cast<double>(sum) / static_cast<double>(drawn(all, counts));
}

/// Replications with trips, of both where two are given.
struct Chosen {
    Trips condition;
    Trips baseline;
};

Chosen chosen_from(std::span<const results::RunRecord* const> runs,
                   std::span<const results::RunRecord* const> baseline) {
    Chosen chosen;
    for (std::size_t replication = 0; replication < runs.size(); ++replication) {
        if (runs[replication] == nullptr) continue;
        auto times = response_times_s(*runs[replication]);
        if (times.empty()) continue;
        if (baseline.empty()) {
            chosen.condition.push_back(std::move(times));
            continue;
        }
        if (replication >= baseline.size() || baseline[replication] == nullptr) continue;
        auto before = response_times_s(*baseline[replication]);
        if (before.empty()) continue;
        chosen.condition.push_back(std::move(times));
        chosen.baseline.push_back(std::move(before));
    }
    return chosen;
}

using Statistic = std::function<double(RowCounts)>;

MaybeEstimate resampled(std::size_t replications, double level, const Statistic& statistic) {
    if (replications == 0) return std::nullopt;
    const std::vector<std::uint8_t> once(replications, 1);
    Estimate result{replications, statistic(once), 0.0, std::nullopt};
    if (replications < fewest_for_interval) return result;
    BootstrapConfig config;
    config.level = level;
    result.interval = bootstrap_bca(Resamples(replications, config), statistic);
    return result;
}

}  // namespace

std::optional<double> horizon_s(const results::RunRecord& run) {
    double lost = 0.0;
    double all = 0.0;
    double sum_s = 0.0;
    for (const metrics::VehicleRow& vehicle : run.vehicles) {
        if (vehicle.vehicle_class != traffic::VehicleClass::emergency) continue;
        all += 1.0;
        if (arrived(vehicle))
            sum_s += *vehicle.travel_time_s;
        else
            lost += 1.0;
    }
    if (lost == 0.0) return std::nullopt;
    return (run.metrics.emergency_restricted_travel_time_s.value() * all - sum_s) / lost;
}

std::vector<double> response_times_s(const results::RunRecord& run) {
    std::vector<double> times;
    const std::optional<double> lost_s = horizon_s(run);
    for (const metrics::VehicleRow& vehicle : run.vehicles)
        if (vehicle.vehicle_class == traffic::VehicleClass::emergency)
            times.push_back(arrived(vehicle) ? *vehicle.travel_time_s : lost_s.value());
    return times;
}

std::optional<double> usual_response_threshold_s(std::span<const results::RunRecord* const> runs) {
    std::map<std::pair<std::uint32_t, std::string>, double> routes_m;
    for (const results::RunRecord* const run : runs) {
        if (run == nullptr) continue;
        for (const metrics::VehicleRow& vehicle : run->vehicles) {
            if (vehicle.vehicle_class == traffic::VehicleClass::emergency && arrived(vehicle) &&
                vehicle.route_length_m)
                routes_m.try_emplace({run->key.replication, vehicle.id}, *vehicle.route_length_m);
        }
    }
    if (routes_m.empty()) return std::nullopt;
    double sum_m = 0.0;
    for (const auto& [trip, length_m] : routes_m)
        sum_m += length_m;
    const double mean_km = sum_m / static_cast<double>(routes_m.size()) / 1000.0;
    constexpr double rounding_s = 5.0;
    return std::max(rounding_s, std::round(response_pace_s_per_km * mean_km / rounding_s) * rounding_s);
}

ResponseTime response_of(std::span<const results::RunRecord* const> runs,
                         std::span<const results::RunRecord* const> baseline, double threshold_s,
                         double level) {
    ResponseTime response;
    response.threshold_s = threshold_s;
    const Chosen alone = chosen_from(runs, {});
    const std::vector<Weighted> all = ranked(alone.condition);
    response.trips = all.size();
    const std::size_t replications = alone.condition.size();
    if (all.size() >= ResponseTime::fewest_trips)
        response.percentile_90_s =
            resampled(replications, level, [&](RowCounts counts) { return percentile_90_s(all, counts); });
    response.in_time = resampled(replications, level,
                                 [&](RowCounts counts) { return share_in_time(all, counts, threshold_s); });
    if (baseline.empty()) return response;
    const Chosen both = chosen_from(runs, baseline);
    const std::vector<Weighted> with = ranked(both.condition);
    const std::vector<Weighted> without = ranked(both.baseline);
    const std::size_t pairs = both.condition.size();
    if (std::min(with.size(), without.size()) >= ResponseTime::fewest_trips)
        response.percentile_90_difference_s = resampled(pairs, level, [&](RowCounts counts) {
            return percentile_90_s(with, counts) - percentile_90_s(without, counts);
        });
    response.in_time_difference = resampled(pairs, level, [&](RowCounts counts) {
        return share_in_time(with, counts, threshold_s) - share_in_time(without, counts, threshold_s);
    });
    return response;
}

}  // namespace clearway::analysis
