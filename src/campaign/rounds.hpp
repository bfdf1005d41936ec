#pragma once

#include "campaign/run_plan.hpp"

namespace clearway::campaign {

/// Runs a study with a precision target in rounds. Each round has as many replications as the variation so
/// far requires (FHWA's rule, analysis::required_replications). It reports each round on standard error,
/// stops when the target or its cap is reached, and then publishes as run_and_print does. A study that is
/// continued in its folder takes the same rounds to the same results.
core::ExitCode run_in_rounds(study::StudyConfig config, RunPlanOptions options);

/// Replications that a study with a precision target has reached in a folder; those of the first round if it
/// has not begun.
std::uint32_t replications_so_far(const study::StudyConfig& config, const std::filesystem::path& folder);

}  // namespace clearway::campaign
