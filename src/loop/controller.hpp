#pragma once

#include "core/random.hpp"
#include "experiment/condition.hpp"
#include "loop/closed_loop.hpp"
#include "roads/network.hpp"

namespace clearway::loop {

/// What all conditions of a worker share. References outlive the controllers made from it.
struct ControllerContext {
    const roads::Network& network;
    core::KeyedRandom random{core::StudySeed{}, core::Replication{}};
    LoopConfig loop;
    drivers::SirenConfig siren;
    drivers::PrivilegeConfig privilege = {};
    double friction = 1.0;                             ///< See scenario::RoadCondition.
    bool has_pedestrians = true;                       ///< Whether there may be pedestrians.
    std::vector<traffic::Preemption> preemption = {};  ///< By signal; empty: none is set.
    policy::GuestMaker guest = {};                     ///< See pipeline::ChainContext.
};

/// Sensors, predictor, policies and actuation of a condition. Throws core::InputError for unknown names and
/// settings.
Controller make_controller(const experiment::ConditionSpec& condition, const ControllerContext& context);

/// The ids that a session of this network maps to indices.
sumo::Names names_of(const roads::Network& network);

/// What became of the leases and requests of a run.
metrics::LeaseTotals totals_of(const Controller& controller);

}  // namespace clearway::loop
