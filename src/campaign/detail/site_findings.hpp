#pragma once

#include "campaign/fitness.hpp"

namespace clearway::campaign::detail {

/// Where the emergency vehicles of trips start and arrive, and what stands in for a kind of site that the
/// scenario does not have.
Finding sites_finding(const scenario::ScenarioConfig& config);

}  // namespace clearway::campaign::detail
