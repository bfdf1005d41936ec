#pragma once

#include <vector>

#include "core/error.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario::detail {

/// Applies what the command line changes; problems name the option.
void apply(const Options& options, ScenarioConfig& config, std::vector<core::Problem>& problems);

/// What no single key can be checked for: keys that contradict or need each other, and files that must exist.
void check(const ScenarioConfig& config, std::vector<core::Problem>& problems);

}  // namespace clearway::scenario::detail
