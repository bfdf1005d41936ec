#pragma once

#include "roads/network.hpp"
#include "traffic/incident.hpp"

namespace clearway::roads {

/// Whether no lane of the edge that an emergency vehicle may use stays open.
bool closes_to_emergency(const Network& network, const traffic::Incident& incident);

/// What is known of an incident once it is known.
traffic::KnownIncident known(const Network& network, const traffic::Incident& incident);

/// A point on its edge, on the middle of its closed lanes.
Point place_of(const Network& network, const traffic::Incident& incident);

}  // namespace clearway::roads
