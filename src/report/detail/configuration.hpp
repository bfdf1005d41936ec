#pragma once

#include <string>

#include "report/facts.hpp"

namespace clearway::report::detail {

/// Fills in what a stored scenario.toml says: steps, horizon, blockers, and what the figures rest on, which
/// also needs the scenario's roads and baseline.
void add_configuration(const std::string& configuration, ScenarioFacts& scenario);

}  // namespace clearway::report::detail
