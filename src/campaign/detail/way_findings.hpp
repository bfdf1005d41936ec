#pragma once

#include <map>
#include <string>
#include <vector>

#include "campaign/detail/emergency_trips.hpp"
#include "campaign/fitness.hpp"

namespace clearway::campaign::detail {

/// `Avenue de la Costa (edge 12#3)`, with more words behind the id.
std::string road_words(const roads::Edge& edge, const std::string& more = "");

/// What the network leaves emergency vehicles to choose: how many have two ways or more within a fifth of the
/// fastest by free flow; which station is nearest to calls; and, where there are incidents, whom they cut
/// off, of the trips of more seeds where they are given.
std::vector<Finding> way_findings(const scenario::ScenarioConfig& config, const roads::Network& network,
                                  const std::vector<EmergencyTrip>& planned,
                                  const std::vector<EmergencyTrip>& of_more_seeds = {});

/// The trips that are called to a road that an incident closes then, before which they end in the queue, each
/// with the road and until when, `edge B1C1, closed until 900 s`.
std::map<std::string, std::string> queueing_trips(const scenario::ScenarioConfig& config,
                                                  const roads::Network& network,
                                                  const std::vector<EmergencyTrip>& planned);

/// What such trips need to reach their place meanwhile.
inline constexpr const char* queueing_cure =
    "leave a lane open (lanes), or emergency_passes = 1 with a reroute_share, for EVs to reach the place";

/// How many emergency vehicles' trips pass a road while an incident blocks it, and how many are called to
/// one; where few do, up to three roads that most of them pass near their middles, with a way round.
/// `planned`: of all replications.
Finding passing_finding(const scenario::ScenarioConfig& config, const roads::Network& network,
                        const std::vector<EmergencyTrip>& planned, std::size_t replications);

}  // namespace clearway::campaign::detail
