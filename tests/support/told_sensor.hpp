#pragma once

#include <utility>

#include "sensing/sensor.hpp"

namespace clearway::support {

/// Reports what it is told, at every step, and logs nothing.
class ToldSensor : public sensing::SensorModel {
  public:
    explicit ToldSensor(traffic::Observation observation) : told_(std::move(observation)) {}
    void observe(const truth::Snapshot& snapshot, const traffic::Roster&,
                 traffic::Observation& observation) override {
        observation = told_;
        observation.time = snapshot.time;
    }
    void log_failures(const truth::Snapshot&, const graph::ProximityGraph&,
                      sensing::FailureLog&) const override {}

  protected:
    traffic::Observation told_;
};

}  // namespace clearway::support
