#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// Times of the route files, in s: what a flow without a begin or an end takes, and between which times its
/// departures are wanted.
struct FlowTimes {
    double begin_s = 0.0;
    double end_s = 3600.0;
    double from_s = 0.0;
    double until_s = std::numeric_limits<double>::infinity();  ///< Departures at it are not wanted.
};

/// One vehicle or person of a flow.
struct Departure {
    std::size_t number = 0;  ///< From 0, those that are not wanted included.
    double at_s = 0.0;
    double later_s = 0.0;  ///< After the first, where they depart at regular times: what SUMO adds to the
                           ///< times of their stops.
};

/// The wanted departures of a `<flow>` or `<personFlow>` that counts `scale` times, by time; those by chance
/// are drawn by the flow's id. Nothing when it states no rate. Takes memory for the wanted ones only; a flow
/// without an end is cut a day after its begin or the first wanted time.
std::optional<std::vector<Departure>> departures(const Element& flow, const FlowTimes& times, double scale);

}  // namespace clearway::scenario_import::detail
