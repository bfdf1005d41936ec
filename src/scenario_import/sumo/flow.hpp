#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// Times of the route files, s: the default begin and end of a flow, and the range in which departures are
/// wanted.
struct FlowTimes {
    double begin_s = 0.0;
    std::optional<double> end_s;  ///< Nothing: a day after the flow's begin, as SUMO has it.
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
/// end is cut off a day after its begin or the first wanted time. A number of vehicles whose end is its begin
/// departs at once.
std::optional<std::vector<Departure>> departures(const Element& flow, const FlowTimes& times, double scale);

/// Why SUMO 1.15 refuses the times and rates of a flow, in words; nothing when it accepts them.
std::optional<std::string> fault_of_flow(const Element& flow, const FlowTimes& times);

}  // namespace clearway::scenario_import::detail
