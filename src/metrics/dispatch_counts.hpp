#pragma once

#include <cstdint>

#include "metrics/tried_choices.hpp"

namespace clearway::metrics {

/// How the calls of a scenario were answered in a run.
struct DispatchCounts {
    std::uint64_t sent = 0;     ///< Vehicles.
    std::uint64_t missing = 0;  ///< Called, but no station had one left that could get there.
    TriedChoices units = {};    ///< Those that were sent, against units of other stations.
};

}  // namespace clearway::metrics
