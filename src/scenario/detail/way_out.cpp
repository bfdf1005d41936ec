#include "scenario/detail/way_out.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "roads/closure.hpp"
#include "roads/exits.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario::detail {
namespace {

std::optional<core::EdgeIndex> only_way_out(const roads::Network& network, core::EdgeIndex from) {
    const auto exits = roads::exits(network, from, roads::Driver::emergency);
    return exits.size() == 1 ? std::optional(exits.front()) : std::nullopt;
}

/// The incident that closes an edge to an emergency vehicle at some time of an interval.
const PlacedIncident* closing(const roads::Network& network, const std::vector<PlacedIncident>& incidents,
                              core::EdgeIndex edge, double first_s, double last_s) {
    // An EV that comes at the very moment counts as well.
    constexpr double instant_s = 0.01;
    const auto found = std::ranges::find_if(incidents, [&](const PlacedIncident& placed) {
        const traffic::Incident& incident = placed.closed;
        return incident.edge == edge && roads::closes_to_emergency(network, incident) &&
               incident.from.value < last_s + instant_s && first_s < incident.to.value;
    });
    return found == incidents.end() ? nullptr : &*found;
}

}  // namespace

void check_way_out(const ScenarioConfig& config, const roads::Network& network,
                   const std::vector<PlacedIncident>& incidents, const Leaving& leaving,
                   std::vector<core::Problem>& problems) {
    std::vector<core::EdgeIndex> passed;
    double elapsed_s = 0.0;
    for (std::optional<core::EdgeIndex> edge = leaving.edge; edge; edge = only_way_out(network, *edge)) {
        if (edge == leaving.end || std::ranges::find(passed, *edge) != passed.end()) return;
        passed.push_back(*edge);
        const PlacedIncident* const found =
            closing(network, incidents, *edge, leaving.first_s + elapsed_s, leaving.last_s + elapsed_s);
        if (found != nullptr) {
            problems.push_back(
                {config.where(fmt::format("incident[{}]", found->row)),
                 fmt::format("closes edge \"{}\", the only way out of {} at \"{}\"", network.edge(*edge).id,
                             leaving.key, network.edge(leaving.edge).id),
                 "an edge with a way round it, or times when no EV starts there",
                 "close another edge, leave a lane open, or set emergency_passes = 1"});
            return;
        }
        const roads::Lane& lane = network.lane(network.lane_of(*edge, 0));
        elapsed_s += lane.length_m / lane.speed_limit_mps;
    }
}

}  // namespace clearway::scenario::detail
