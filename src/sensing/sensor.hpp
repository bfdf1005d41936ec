#pragma once

#include <memory>
#include <string>

#include "core/random.hpp"
#include "core/units.hpp"
#include "traffic/observation.hpp"
#include "truth/snapshot.hpp"

namespace clearway::sensing {

/// From the true state to what was reported. Failures are drawn per report (1 Hz by default, whatever the step) and keyed
/// by vehicle and report number, so that every condition of a replication meets the same ones. A model keeps state between
/// steps (the last report of each vehicle) and is used by one thread.
class SensorModel {
  public:
    SensorModel() = default;
    SensorModel(const SensorModel&) = delete;
    SensorModel& operator=(const SensorModel&) = delete;
    virtual ~SensorModel() = default;

    /// Called once per simulation step with the present truth; writes what is known into `observation`, whose buffers are
    /// reused. `roster` is the true one; the observation refers to a roster of those that reported.
    virtual void observe(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                         traffic::Observation& observation) = 0;
};

}  // namespace clearway::sensing
