#pragma once

#include <optional>
#include <string>

#include "study/plan.hpp"

namespace clearway::cli {

/// What a plan would do, for `--dry-run`: cells, runs, those already in `folder`, and the time and disk that
/// the rest should take with `workers` processes (0: one per core).
std::string plan_text(const study::Plan& plan, const std::filesystem::path& folder, unsigned workers);
/// The same as JSON.
std::string plan_json(const study::Plan& plan, const std::filesystem::path& folder, unsigned workers);
/// Wall time of what is left of a plan with `workers` processes, s; nothing where nobody can tell.
std::optional<double> estimated_time_left_s(const study::Plan& plan, const std::filesystem::path& folder,
                                            unsigned workers);

}  // namespace clearway::cli
