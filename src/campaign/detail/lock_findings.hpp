#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "campaign/fitness.hpp"
#include "metrics/traffic_tables.hpp"

namespace clearway::campaign::detail {

/// Names of the findings below.
inline constexpr const char* locks_name = "locks";
inline constexpr const char* trials_name = "trials";

/// What locks do in runs of the baseline with one choice about `time.ignore_junction_blocker_s`.
struct LockTrial {
    std::size_t locked = 0;   ///< Runs with a lock.
    std::size_t held_up = 0;  ///< Of them: an EV or more than one vehicle in a hundred stood in one.
    double stood_s = 0.0;     ///< In locks, mean over all vehicles.
    double collisions = 0.0;  ///< Mean over the runs.
};
/// The same seeds with the choice of the scenario and with the other one.
struct LockTrials {
    std::uint32_t trials = 0;
    double ignored_after_s = 0.0;  ///< `time.ignore_junction_blocker_s` where vehicles are ignored.
    bool ignores = false;          ///< Whether the scenario has it.
    LockTrial with;
    LockTrial without;
};
/// Falls short where locks hold up runs of the scenario as it is.
Finding trials_finding(const LockTrials& trials);

/// The locks of a baseline run: how many, where, and what to try. Falls short where an EV or more than one
/// vehicle in a hundred stood in one. `less`: how to get less traffic.
Finding locks_finding(const results::RunRecord& record, const std::vector<metrics::LockRow>& locks,
                      const Checked& checked, const std::string& less);

/// Adds a run of the baseline, one of `trials`.
void count_trial(const metrics::RunMetrics& run, std::uint32_t trials, LockTrial& trial);

}  // namespace clearway::campaign::detail
