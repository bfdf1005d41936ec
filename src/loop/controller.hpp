#pragma once

#include "core/random.hpp"
#include "experiment/condition.hpp"
#include "loop/closed_loop.hpp"
#include "roads/network.hpp"

namespace clearway::loop {

/// What every condition of a worker shares; references outlive what is made from it.
struct ControllerContext {
    const roads::Network& network;
    core::KeyedRandom random{core::StudySeed{}, core::Replication{}};
    LoopConfig loop;
    drivers::SirenConfig siren;
    double friction = 1.0;        ///< Of scenario::RoadCondition.
    bool has_pedestrians = true;  ///< Whether there may be any.
};

/// Sensors, predictor, policies and actuation of a condition. Throws core::InputError for names and settings
/// that do not exist.
Controller make_controller(const experiment::ConditionSpec& condition, const ControllerContext& context);

/// The names that a session of this network speaks in indices of.
sumo::Names names_of(const roads::Network& network);

/// What became of the leases of a run.
metrics::LeaseTotals totals_of(const actuation::Actuator& actuator);

}  // namespace clearway::loop
