#pragma once

#include <filesystem>

#include "scenario/config.hpp"
#include "scenario/network.hpp"
#include "scenario/prepare.hpp"

namespace clearway::scenario {

/// Writes a replication's demand as files of SUMO alone into `folder`: network.net.xml,
/// vehicle_types.add.xml, traffic.rou.xml, emergency.rou.xml, those of people on foot, the additional files,
/// and run.sumocfg, so that `sumo -c run.sumocfg` shows the baseline in any SUMO. Throws as `prepare` does.
void write_sumo_files(const ScenarioConfig& config, const BuiltNetwork& network, core::StudySeed seed,
                      core::Replication replication, const std::filesystem::path& folder);

}  // namespace clearway::scenario
