#pragma once

#include <cstddef>
#include <span>

#include "analysis/estimate.hpp"
#include "results/record.hpp"

namespace clearway::analysis {

/// The emergency vehicles that came to a road which an incident closed to them in runs of the baseline, and
/// what a condition is worth to them: the others have nothing to gain from a choice of the way.
struct MetIncident {
    std::size_t vehicles = 0;  ///< In the runs of the baseline that have a pair.
    std::size_t still = 0;     ///< Of these: also in the condition's run.
    /// Of their mean travel time by replication, restricted to the horizon, s.
    MaybeEstimate difference_s;
};

/// Of a condition's runs by replication (null where there is none), compared with `baseline`.
MetIncident met_incident(std::span<const results::RunRecord* const> runs,
                         std::span<const results::RunRecord* const> baseline, double level = usual_level);

}  // namespace clearway::analysis
