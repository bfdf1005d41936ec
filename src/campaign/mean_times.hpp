#pragma once

#include <cstdint>
#include <filesystem>

#include "campaign/printing.hpp"
#include "core/error.hpp"
#include "scenario/config.hpp"

namespace clearway::campaign {

/// How mean times are made.
struct MeanTimesOrder {
    std::filesystem::path file;     ///< That is written; never over one that is there.
    std::uint64_t study_seed = 77;  ///< Other than that of any study which uses them.
    std::uint32_t runs = 10;
    unsigned jobs = 0;  ///< Worker processes at a time; 0: one per core.
    Printing printing = Printing::text;
};

/// Edges that fewer vehicles drove over, in all runs together, have no mean time.
inline constexpr std::uint64_t least_vehicles_of_mean = 5;

/// Runs the scenario as it is on other days, without its incidents and with nothing done for emergency
/// vehicles, and writes the mean times of other vehicles on its edges (scenario/mean_times.hpp). Throws
/// core::InputError when the file is there already.
core::ExitCode write_mean_times(scenario::ScenarioConfig config, const MeanTimesOrder& order);

}  // namespace clearway::campaign
