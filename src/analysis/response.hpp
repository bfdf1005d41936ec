#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "analysis/bootstrap.hpp"
#include "analysis/estimate.hpp"
#include "results/record.hpp"

namespace clearway::analysis {

/// Pace from which the threshold of a scenario follows unless the user gives one, s/km: NFPA 1710 allows the
/// first unit 240 s, and a company is to stand within 1.5 road miles (2.4 km) of what it protects (ISO, Fire
/// Suppression Rating Schedule).
inline constexpr double response_pace_s_per_km = 100.0;

/// How many emergency vehicles come in time, and how late the slow ones are: statistics of all trips, with
/// BCa intervals from resampling whole replications; none below `fewest_for_interval` replications.
struct ResponseTime {
    /// Trips of which one is beyond the percentile; of fewer it would be the slowest.
    static constexpr std::size_t fewest_trips = 10;
    double threshold_s = 0.0;
    std::size_t trips = 0;
    /// Nothing below `fewest_trips`. A vehicle that did not arrive counts with the horizon, and as too late.
    MaybeEstimate percentile_90_s;
    MaybeEstimate in_time;  ///< Share of trips that took no longer than the threshold; nothing without trips.
    /// Against the baseline, over the replications that are complete in both.
    MaybeEstimate percentile_90_difference_s;
    MaybeEstimate in_time_difference;
};

/// The time with which the restricted mean counts an emergency vehicle that did not arrive, s; a record does
/// not state it. Nothing if all of a run arrived.
std::optional<double> horizon_s(const results::RunRecord& run);
/// Travel times of the emergency vehicles of a run, s, those that did not arrive with the horizon.
std::vector<double> response_times_s(const results::RunRecord& run);

/// `response_pace_s_per_km` times the mean route of the emergency vehicles that arrived, rounded to 5 s, at
/// least 5 s. Every trip of the runs counts once, however many conditions it was driven in. Nothing if none
/// arrived.
std::optional<double> usual_response_threshold_s(std::span<const results::RunRecord* const> runs);

/// Of a condition's runs by replication (null where there is none), compared with `baseline`, which may be
/// empty.
ResponseTime response_of(std::span<const results::RunRecord* const> runs,
                         std::span<const results::RunRecord* const> baseline, double threshold_s,
                         double level = usual_level);

}  // namespace clearway::analysis
