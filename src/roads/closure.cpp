#include "roads/closure.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::roads {

bool closes_to_emergency(const Network& network, const traffic::Incident& incident) {
    if (incident.emergency_passes) return false;
    const Edge& edge = network.edge(incident.edge);
    for (std::uint32_t number = 0; number < edge.lane_count; ++number) {
        const bool is_open = network.lane(network.lane_of(incident.edge, number)).allows_emergency;
        if (is_open && !std::ranges::binary_search(incident.lanes, number)) return false;
    }
    return true;
}

traffic::KnownIncident known(const Network& network, const traffic::Incident& incident) {
    return {.edge = incident.edge,
            .closed_to_emergency = closes_to_emergency(network, incident),
            .speed_past_mps = incident.speed_past_mps};
}

Point place_of(const Network& network, const traffic::Incident& incident) {
    assert(!incident.lanes.empty());
    const std::uint32_t lane = incident.lanes[incident.lanes.size() / 2];
    return network.point_at(network.lane_of(incident.edge, lane), core::Metres(incident.position_m));
}

}  // namespace clearway::roads
