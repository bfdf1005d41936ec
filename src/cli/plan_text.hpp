#pragma once

#include <string>

#include "study/plan.hpp"

namespace clearway::cli {

/// What a plan would do, for `--dry-run`: cells, runs, those already in `folder`, and the time that the rest
/// should take with `workers` processes (0: one per core).
std::string plan_text(const study::Plan& plan, const std::filesystem::path& folder, unsigned workers);
/// The same as JSON.
std::string plan_json(const study::Plan& plan, const std::filesystem::path& folder, unsigned workers);

}  // namespace clearway::cli
