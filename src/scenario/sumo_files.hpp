#pragma once

#include <cstdint>
#include <filesystem>

#include "scenario/config.hpp"
#include "scenario/network.hpp"
#include "scenario/prepare.hpp"

namespace clearway::scenario {

/// Width of the strips in which vehicles move sideways under the sublane model, m. SUMO's own examples; half
/// a bicycle.
inline constexpr const char* sublane_resolution_m = "0.5";

/// SUMO's model of lateral movement.
enum class LateralModel : std::uint8_t { lanes, sublane };

/// A run as far as files of SUMO can say it.
struct SumoRun {
    core::StudySeed seed;
    core::Replication replication;
    LateralModel lateral_model = LateralModel::lanes;
    traffic::BlueLight bluelight = traffic::BlueLight::off;  ///< Of every emergency vehicle.
};

/// Writes a run as files of SUMO alone into `folder`: network.net.xml, vehicle_types.add.xml,
/// traffic.rou.xml, emergency.rou.xml, those of people on foot, the additional files, and run.sumocfg, so
/// that `sumo -c run.sumocfg` shows it in any SUMO. What a policy does is not in them. Throws as `prepare`
/// does.
void write_sumo_files(const ScenarioConfig& config, const BuiltNetwork& network, const SumoRun& run,
                      const std::filesystem::path& folder);

}  // namespace clearway::scenario
