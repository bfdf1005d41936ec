#pragma once

#include <filesystem>

#include "scenario/config.hpp"
#include "scenario/network.hpp"
#include "scenario/prepare.hpp"
#include "traffic/command.hpp"

namespace clearway::scenario {

/// Width of the strips of the sublane model, in which vehicles move sideways, m. As in SUMO's own examples.
inline constexpr const char* sublane_resolution_m = "0.5";

/// A run, as far as SUMO files can describe it.
struct SumoRun {
    core::StudySeed seed;
    core::Replication replication;
    traffic::LateralModel lateral_model = traffic::LateralModel::lane;
    traffic::BlueLight bluelight = traffic::BlueLight::off;  ///< For every emergency vehicle.
    double rerouting_s = 0.0;                                ///< Likewise, see traffic::EmergencyDeparture.
};

/// Writes a run into `folder` as plain SUMO files: network.net.xml, vehicle_types.add.xml, traffic.rou.xml,
/// emergency.rou.xml, those of pedestrians, the additional files, and run.sumocfg, so that `sumo -c
/// run.sumocfg` runs it in any SUMO. They do not contain the actions of a policy. Throws as `prepare` does.
void write_sumo_files(const ScenarioConfig& config, const BuiltNetwork& network, const SumoRun& run,
                      const std::filesystem::path& folder);

}  // namespace clearway::scenario
