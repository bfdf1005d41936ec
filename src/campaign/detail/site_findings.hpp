#pragma once

#include <chrono>
#include <string>

#include "campaign/fitness.hpp"

namespace clearway::campaign::detail {

/// Where the emergency vehicles of trips start and arrive, and what stands in for a kind of site that the
/// scenario does not have.
Finding sites_finding(const scenario::ScenarioConfig& config);

/// How old the map data of a scenario is, by `network.map_date`.
Finding map_finding(const std::string& map_date, std::chrono::sys_days on_day);

}  // namespace clearway::campaign::detail
