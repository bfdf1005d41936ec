#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiment/condition.hpp"
#include "metrics/link_quality.hpp"
#include "metrics/run_metrics.hpp"
#include "roads/network.hpp"
#include "trace/recording.hpp"

namespace clearway::trace {

/// How good believed links were, over the report rounds with a decision.
struct LinkScore {
    std::uint64_t decisions = 0;
    std::uint64_t scored = 0;   ///< Of them, those at report rounds.
    metrics::LinkCounts links;  ///< All links.
    metrics::LinkCounts dark;   ///< Links with an end whose newest report did not arrive.
    std::uint64_t leases = 0;   ///< Leases issued, renewals included.
};

/// How many recorded structs the replay reproduced bit for bit.
struct Agreement {
    std::uint64_t compared = 0;
    std::uint64_t same = 0;
    std::string first_difference;  ///< `at 61.5 s: vehicles[3].state.x_m: 12.5, then 12.25`; empty: none.
};

/// What a run recorded, and what the same traffic gives on replay.
struct ReplayResult {
    double begin_s = 0.0;  ///< Times of the first and the last recorded step.
    double end_s = 0.0;
    std::uint64_t steps = 0;
    std::uint64_t vehicle_steps = 0;
    LinkScore recorded;  ///< No decisions if the recorded condition has no policy.
    LinkScore replayed;
    /// Quality of the predictor's probabilities for all candidates (pairs with a dark end) at report rounds.
    metrics::LinkQuality candidates;
    Agreement observations, beliefs, leases;
};

/// Reads a recording to its end and runs sensing (with the recorded run's draws), prediction and policy of
/// `condition` over it. The traffic does not react: it stays as recorded. `network` is that of the recording;
/// this is not checked here. A decision is made at every policy period, even when the recorded condition had
/// no policy. Memory grows with the number of candidates, 9 bytes each. Throws core::InputError for unknown
/// names and as RecordingReader does.
/// `mean_times_s` as in policy::PolicyContext.
ReplayResult replay(RecordingReader& recording, const experiment::ConditionSpec& condition,
                    const roads::Network& network, const std::vector<double>& mean_times_s = {});

}  // namespace clearway::trace
