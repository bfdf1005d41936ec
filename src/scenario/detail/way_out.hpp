#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/ids.hpp"
#include "roads/network.hpp"
#include "scenario/incident.hpp"

namespace clearway::scenario::detail {

/// An emergency vehicle that leaves a start at some time of an interval, s.
struct Leaving {
    std::string key;  ///< Of the start, `emergency_site[0]`.
    core::EdgeIndex edge;
    double first_s = 0.0;
    double last_s = 0.0;
    std::optional<core::EdgeIndex> end = {};  ///< Where it is going, if that is known.
};

/// Adds a problem where incidents close the only way out of a start then, alone or together: the way is
/// followed as long as there is but one, up to its end or to edges of which one is open.
void check_way_out(const ScenarioConfig& config, const roads::Network& network,
                   const std::vector<PlacedIncident>& incidents, const Leaving& leaving,
                   std::vector<core::Problem>& problems);

}  // namespace clearway::scenario::detail
