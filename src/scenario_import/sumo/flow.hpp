#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// Times of the route files, s: the default begin and end of a flow, and the range in which departures are
/// wanted.
struct FlowTimes {
    double begin_s = 0.0;
    double end_s = 3600.0;
    double from_s = 0.0;
    double until_s = std::numeric_limits<double>::infinity();  ///< Exclusive.
};

/// One vehicle or person of a flow.
struct Departure {
    std::size_t number = 0;  ///< From 0; unwanted ones count too.
    double at_s = 0.0;
    /// Time after the first departure if they are regular: SUMO adds it to the times of their stops.
    double later_s = 0.0;
};

/// The wanted departures of a `<flow>` or `<personFlow>`, scaled by `scale`, by time; random ones are keyed
/// by the flow's id. Nothing when it states no rate. Takes memory only for the wanted ones; a flow without an
/// end is cut off a day after its begin or the first wanted time.
std::optional<std::vector<Departure>> departures(const Element& flow, const FlowTimes& times, double scale);

}  // namespace clearway::scenario_import::detail
