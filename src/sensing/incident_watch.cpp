#include "sensing/incident_watch.hpp"

#include <algorithm>
#include <cmath>

#include "roads/closure.hpp"

namespace clearway::sensing {

IncidentWatch::IncidentWatch(const roads::Network& network, const std::vector<traffic::Incident>& incidents) {
    for (const traffic::Incident& incident : incidents)
        watched_.push_back(
            {incident, roads::known(network, incident), roads::place_of(network, incident), false});
}

void IncidentWatch::observe(const truth::Snapshot& snapshot, traffic::Observation& observation) {
    observation.incidents.clear();
    const double now_s = snapshot.time.value + core::clock_tolerance_s;
    for (Watched& watched : watched_) {
        const traffic::Incident& incident = watched.incident;
        if (now_s < incident.from.value || now_s >= incident.to.value) continue;
        if (!watched.is_known)
            watched.is_known = incident.known_after
                                   ? now_s >= incident.from.value + incident.known_after->value
                                   : is_seen(watched, snapshot, observation);
        if (watched.is_known) observation.incidents.push_back(watched.known);
    }
}

bool IncidentWatch::is_seen(const Watched& watched, const truth::Snapshot& snapshot,
                            const traffic::Observation& observation) {
    if (!observation.is_report) return false;
    return std::ranges::any_of(observation.vehicles, [&](const traffic::ObservedVehicle& vehicle) {
        if (vehicle.vehicle_class == traffic::VehicleClass::human ||
            vehicle.freshness != traffic::Freshness::fresh)
            return false;
        const auto row = snapshot.row_of(vehicle.key);
        return row && std::hypot(snapshot.x_m[*row] - watched.place.x_m,
                                 snapshot.y_m[*row] - watched.place.y_m) <= sight_m;
    });
}

}  // namespace clearway::sensing
