#pragma once

#include <string>
#include <vector>

#include "campaign/fitness.hpp"

namespace clearway::campaign::detail {

/// What the network leaves emergency vehicles to choose: how many have two ways or more within a fifth of the
/// fastest by free flow; which station is nearest to calls; and, where there are incidents, whom they cut
/// off. `emergency_csv` is what `prepare` wrote.
std::vector<Finding> way_findings(const scenario::ScenarioConfig& config, const roads::Network& network,
                                  const std::string& emergency_csv);

/// How many emergency vehicles' trips pass a road that an incident blocks, at whatever time; where few do,
/// up to three roads that most of them pass near their middles, with a way round. `emergency_csv` is what
/// `prepare` wrote for `replications` replications, one behind the other.
Finding passing_finding(const scenario::ScenarioConfig& config, const roads::Network& network,
                        const std::string& emergency_csv, std::size_t replications);

}  // namespace clearway::campaign::detail
