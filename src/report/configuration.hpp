#pragma once

#include <string>

#include "experiment/condition.hpp"
#include "report/facts.hpp"
#include "roads/network.hpp"

namespace clearway::report {

/// Fills in what a stored scenario.toml says: steps, horizon, blockers, and what the figures rest on, which
/// also needs the scenario's roads and baseline.
void add_configuration(const std::string& configuration, ScenarioFacts& scenario);

/// `Simulated: random trips of 1,159 vehicles in 15 min; ...`: how demand came about and how much of it there
/// is, the speed limits of the roads, how EVs' trips are drawn, how old the map is, and whether EVs of the
/// baseline stop at red. Empty for an old configuration, which says nothing of demand. Plain text.
std::string simulated_sentence(const std::string& configuration, const roads::Network& network,
                               const experiment::ConditionSpec& baseline);

}  // namespace clearway::report
