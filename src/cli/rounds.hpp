#pragma once

#include "cli/run_plan.hpp"

namespace clearway::cli {

/// Runs a study with a precision target in rounds, each with as many replications as the last one's variation
/// asks for (FHWA's rule, analysis::required_replications), until the target or its cap is reached; says so
/// on standard error; then as run_and_print. Continued in its folder, it takes the same way to the same
/// results.
core::ExitCode run_in_rounds(study::StudyConfig config, RunPlanOptions options);

/// Replications that a study with a precision target has asked for so far in a folder; those of the first
/// round where it has not begun.
std::uint32_t replications_so_far(const study::StudyConfig& config, const std::filesystem::path& folder);

}  // namespace clearway::cli
