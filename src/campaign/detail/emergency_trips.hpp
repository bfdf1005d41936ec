#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "roads/network.hpp"

namespace clearway::campaign::detail {

/// The trip of an emergency vehicle, as planned.
struct EmergencyTrip {
    std::string id;
    std::vector<std::string> edges;  ///< With both ends.
    double depart_s = 0.0;           ///< Less the delay that events of its replication have.
};
/// Those of the emergency.csv that `prepare` wrote, without their times.
std::vector<EmergencyTrip> emergency_trips_in(const std::string& csv);

/// The signals between each edge and the next.
using Crossings = std::map<std::pair<std::string, std::string>, std::set<core::SignalIndex>>;
Crossings crossings_of(const roads::Network& network);
/// The signals on a way, in their order, each once.
std::vector<core::SignalIndex> passed_by(const std::vector<std::string>& edges, const Crossings& crossings);

}  // namespace clearway::campaign::detail
