#pragma once

#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "study/config.hpp"

namespace clearway::study {

/// Refuses a study with a plan whose seed was used before: seeds at which somebody has looked prove nothing.
/// Used is the seed of another plan in the folder of `file`, and that of a run folder with a complete run or
/// a plan that is `folder`, where the study is about to run, or lies beside it, and holds anything but this
/// study with as many replications or fewer: one other setting is another study. Versions of the programs may
/// differ. Study files that cannot be read are left out. Returns what is wrong with manifests that cannot be
/// read: whether their runs used the seed is unknown, and the caller says so. Nothing for studies without a
/// plan. Throws core::InputError, naming who used it.
std::vector<core::Problem> check_fresh_seed(const StudyConfig& config, const std::filesystem::path& file,
                                            const std::filesystem::path& folder);

}  // namespace clearway::study
