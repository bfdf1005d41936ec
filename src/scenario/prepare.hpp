#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "scenario/config.hpp"
#include "scenario/network.hpp"
#include "traffic/departure.hpp"

namespace clearway::scenario {

/// What SUMO needs for one replication.
struct Prepared {
    std::filesystem::path network_file;
    /// Human and automated vehicles, by departure; then, if there are any, the persons of measured demand and
    /// the drawn pedestrians.
    std::vector<std::filesystem::path> route_files;
    /// Vehicle types first, then the files that the demand refers to.
    std::vector<std::filesystem::path> additional_files;
    /// By departure. The run adds them after the warm-up; they are in no route file, but in `emergency.csv`.
    /// Those that calls send are planned by free flow: a run decides again.
    std::vector<traffic::EmergencyDeparture> emergency;
    std::vector<PlacedIncident> incidents;
    Calls calls;
    Times time;
    std::vector<std::string> options;  ///< For SUMO, `name=value`.
    std::uint64_t simulator_seed = 1;  ///< For SUMO's own generator, 31 bits, not 0.
    int human = 0;
    int automated = 0;
    std::string demand_hash;  ///< Hash of all files that `prepare` writes.
};

/// Throws core::InputError for a folder with a comma in its path: SUMO separates additional files by commas,
/// and would take such a path for two.
void refuse_commas(const std::filesystem::path& folder);

/// Throws core::InputError for pedestrians in a network that has no crossing for them.
void require_crossings(const ScenarioConfig& config, const roads::Network& network);

/// Writes vehicle types, routes, emergency departures and pedestrians of one replication into `folder` and
/// returns where they are. A pure function of configuration, network, seed and replication: equal arguments
/// give equal bytes, and a vehicle keeps its departure, route and driver when others are added. Throws
/// core::InputError with every unknown edge, unreachable destination and unknown measured type, for persons
/// who cannot walk as planned, for pedestrians in a network without crossings, and as place_incidents does;
/// core::EnvironmentError when `folder` cannot be written.
Prepared prepare(const ScenarioConfig& config, const BuiltNetwork& network, core::StudySeed seed,
                 core::Replication replication, const std::filesystem::path& folder);

}  // namespace clearway::scenario
