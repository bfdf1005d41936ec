#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "roads/network.hpp"

namespace clearway::scenario {

/// What vehicles needed for an edge, over some runs.
struct EdgeMean {
    std::string edge;
    std::uint64_t vehicles = 0;
    double time_s = 0.0;  ///< Mean, > 0.
};

/// Mean times of edges on other days than those of a study, as a scenario may name them
/// (`network.mean_times`).
struct MeanTimes {
    std::string network;           ///< BuiltNetwork::inputs_hash of the network that was driven on.
    std::uint64_t study_seed = 0;  ///< Of the runs; a study with this seed would know its own future.
    std::uint32_t replications = 0;
    std::vector<EdgeMean> edges;
};

/// The text of a file: a line that says where the times come from, then CSV.
std::string mean_times_csv(const MeanTimes& times);

/// Reads such a file. Appends every problem: a file of something else, one that was cut short, numbers that
/// are none.
MeanTimes read_mean_times(const std::filesystem::path& file, std::vector<core::Problem>& problems);

/// Times by core::EdgeIndex, s; 0 for an edge without a row. `inputs_hash` is that of the network. Throws
/// core::InputError for times of another network.
std::vector<double> mean_times_of(const MeanTimes& times, const std::filesystem::path& file,
                                  const roads::Network& network, const std::string& inputs_hash);

}  // namespace clearway::scenario
