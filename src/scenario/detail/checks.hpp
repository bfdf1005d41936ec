#pragma once

#include <vector>

#include "core/error.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario::detail {

/// Applies the overrides (overrides.cpp); problems name the place where one was given.
void apply(const Options& options, ScenarioConfig& config, std::vector<core::Problem>& problems);

/// Checks beyond a single key: keys that contradict or need each other, and files that must exist.
void check(const ScenarioConfig& config, std::vector<core::Problem>& problems);

/// Of incidents, what needs no network.
void check_incidents(const ScenarioConfig& config, std::vector<core::Problem>& problems);
/// Likewise of calls.
void check_calls(const ScenarioConfig& config, std::vector<core::Problem>& problems);

}  // namespace clearway::scenario::detail
