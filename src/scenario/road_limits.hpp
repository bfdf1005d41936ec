#pragma once

#include "roads/limits.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario {

/// The limits of the roads that `build_network` would make, read from their sources without netconvert: an
/// edge of plain XML counts with the distance of its nodes, and one that `restrict` drops counts, too. None
/// where the sources cannot be read; who builds the network says why.
roads::Limits road_limits(const ScenarioConfig& config);

}  // namespace clearway::scenario
