#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "results/store.hpp"

namespace clearway::study {

/// What a study took over from the run folder of another.
struct Reused {
    std::size_t runs = 0;
    std::vector<std::string> other_conditions;  ///< Names that both have for conditions that differ.
    std::vector<std::string> renamed;           ///< `ours (mine2 there)`.
    std::vector<std::string> damaged;           ///< Whole sentences on runs that were left out.
};

/// Runs of a study of which scenario and condition, whatever its name, are the same in `source` and complete
/// there, each with the condition's name there. Throws core::InputError as `reuse` does.
std::map<experiment::RunKey, std::string> reusable_runs(const results::Manifest& study,
                                                        const results::Store& source);

/// Adopts the complete runs of the run folder `from` of which scenario and condition are the same in the
/// study of `store`; what `store` has already stays. Throws core::InputError when seed, SUMO or the build of
/// Clearway differ, so that no run can be the same, and when no scenario or no condition is.
Reused reuse(const results::Store& store, const std::filesystem::path& from);

}  // namespace clearway::study
