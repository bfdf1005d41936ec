#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "campaign/fitness.hpp"
#include "metrics/traffic_tables.hpp"

namespace clearway::campaign::detail {

/// The locks of a baseline run: how many, where, and what to try. Falls short where an EV or more than one
/// vehicle in a hundred stood in one. `less`: how to get less traffic.
Finding locks_finding(const results::RunRecord& record, const std::vector<metrics::LockRow>& locks,
                      const Checked& checked, const std::string& less);

/// Adds a run of the baseline, one of `trials`.
void count_trial(const metrics::RunMetrics& run, std::uint32_t trials, LockTrial& trial);

}  // namespace clearway::campaign::detail
