#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/fields.hpp"

namespace clearway::experiment {

/// One simulation: a scenario and a replication of it.
struct Simulation {
    std::string scenario;
    std::filesystem::path scenario_file;
    std::filesystem::path network_folder;
    std::uint64_t study_seed = 1;
    std::uint32_t replication = 0;

    static constexpr void fields(const auto& table) {
        using Self = Simulation;
        table(core::Field{"scenario", "", &Self::scenario, 0, 0, "Name of the scenario", "given"},
              core::Field{"scenario_file", "", &Self::scenario_file, 0, 0,
                          "The effective configuration, TOML", "stored beforehand"},
              core::Field{"network_folder", "", &Self::network_folder, 0, 0, "Where the network is",
                          "built once for all replications"},
              core::Field{"study_seed", "1", &Self::study_seed, 0, 1.8446744073709552e19,
                          "Seed from which all others follow", "any"},
              core::Field{"replication", "1", &Self::replication, 0, 4294967295.0,
                          "Number of the replication", "any"});
    }
    bool operator==(const Simulation&) const = default;
};

}  // namespace clearway::experiment
