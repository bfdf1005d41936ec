#pragma once

#include <optional>

#include "report/detail/traffic_facts.hpp"

namespace clearway::report::detail {

/// The maps of the condition that a scenario's first screen is about, from all replications that it shares
/// with its baseline. Nothing without roads or a condition to compare, or if the runs did not keep edge
/// times.
std::optional<ScenarioMap> map_in(RunTraffic& traffic, const StudyFacts& study,
                                  const ScenarioFacts& scenario);

}  // namespace clearway::report::detail
