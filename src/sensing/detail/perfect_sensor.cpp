#include "sensing/detail/perfect_sensor.hpp"

namespace clearway::sensing::detail {

traffic::ObservedVehicle exact_report(const truth::Snapshot& snapshot, core::VehicleIndex row) {
    return {.key = snapshot.key[row],
            .vehicle_class = snapshot.vehicle_class[row],
            .freshness = traffic::Freshness::fresh,
            .age_s = 0.0F,
            .position_sigma_m = 0.0F,
            .state = snapshot.motion(row)};
}

void write_own_states(const truth::Snapshot& snapshot, std::vector<traffic::ObservedVehicle>& own_states) {
    own_states.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency) {
            own_states.push_back(exact_report(snapshot, row));
        }
    }
}

void PerfectSensor::observe(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                            traffic::Observation& observation) {
    observation.time = snapshot.time;
    observation.report_time = snapshot.time;
    observation.is_report = true;
    observation.exits_known = true;
    observation.vehicles.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        observation.vehicles.push_back(exact_report(snapshot, row));
    }
    write_own_states(snapshot, observation.own_states);
    observation.detected_links.clear();
    observation.signals = snapshot.signals;
    // Every vehicle on the road has reported, so the true roster is that of the vehicles that reported.
    observation.roster = &roster;
}

void PerfectSensor::log_failures(const truth::Snapshot& snapshot, const graph::ProximityGraph&,
                                 FailureLog& log) const {
    log.time = snapshot.time;
    log.dark.clear();
    log.never_seen.clear();
    log.lost_links.clear();
}

}  // namespace clearway::sensing::detail
