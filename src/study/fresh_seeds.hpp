#pragma once

#include <filesystem>
#include <string>

#include "study/config.hpp"

namespace clearway::study {

/// Refuses a study with a plan whose seed was used before: seeds at which somebody has looked prove nothing.
/// Used is a seed of another study file in the folder of `file`, and of another study's run folder beside
/// `folder`, where the study is about to run; the same study with another plan is another one. Files and
/// folders that cannot be read are left out: they ran nothing. Nothing for studies without a plan. Throws
/// core::InputError, naming who used it.
void check_fresh_seed(const StudyConfig& config, const std::filesystem::path& file,
                      const std::filesystem::path& folder);

}  // namespace clearway::study
