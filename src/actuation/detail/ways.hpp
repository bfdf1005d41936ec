#pragma once

#include <vector>

#include "core/ids.hpp"
#include "roads/network.hpp"

namespace clearway::actuation::detail {

/// Lanes that a way through a junction leads over, in order; a crossing for people on foot is its own lane.
std::vector<core::LaneIndex> lanes_of_way(const roads::Network& network, const roads::SignalLink& way);

/// The part of two ways in which vehicles on them would touch; distances from the start of each, m.
struct SharedArea {
    double last_on_first_m = 0.0;
    double first_on_second_m = 0.0;
};

/// Both lines are sampled every metre; they share an area where they are closer than vehicles are wide. Ways
/// that never are (a right-of-way table may be cautious) share all of the first, and nothing comes before it
/// on the second.
SharedArea shared_area(const roads::Network& network, const roads::SignalLink& first,
                       const roads::SignalLink& second);

/// Whether the road leaves more than 45 degrees off its direction before the junction.
bool turns(const roads::Network& network, const roads::SignalLink& way);

/// Length of a way through a junction, m.
double length_of_way(const roads::Network& network, const roads::SignalLink& way);

}  // namespace clearway::actuation::detail
