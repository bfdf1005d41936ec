#pragma once

#include "sensing/sensor.hpp"

namespace clearway::sensing::detail {

/// Every vehicle reports its exact state at every step.
class PerfectSensor final : public SensorModel {
  public:
    void observe(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                 traffic::Observation& observation) override;
    void log_failures(const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
                      FailureLog& log) const override;
};

/// The state of row `row` as the vehicle itself knows it.
traffic::ObservedVehicle exact_report(const truth::Snapshot& snapshot, core::VehicleIndex row);
/// The exact reports of all emergency vehicles of the snapshot, ordered by key.
void write_own_states(const truth::Snapshot& snapshot, std::vector<traffic::ObservedVehicle>& own_states);

}  // namespace clearway::sensing::detail
