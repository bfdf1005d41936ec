#pragma once

#include <optional>
#include <string>

#include "study/plan.hpp"

namespace clearway::campaign {

/// What a plan would do, for `--dry-run`: cells, runs, those already in `folder`, and the estimated time and
/// disk space of the rest with `workers` processes (0: one per core).
std::string plan_text(const study::Plan& plan, const std::filesystem::path& folder, unsigned workers);
/// The same as JSON.
std::string plan_json(const study::Plan& plan, const std::filesystem::path& folder, unsigned workers);
/// Estimated wall time of the rest of a plan with `workers` processes, s; nothing when it cannot be
/// estimated.
std::optional<double> estimated_time_left_s(const study::Plan& plan, const std::filesystem::path& folder,
                                            unsigned workers);

}  // namespace clearway::campaign
