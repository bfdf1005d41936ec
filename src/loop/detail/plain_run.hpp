#pragma once

#include <memory>
#include <string>

#include "core/random.hpp"
#include "experiment/condition.hpp"
#include "experiment/simulation.hpp"
#include "sensing/sensor.hpp"

namespace clearway::loop::detail {

// Shared by runs without a policy, whose traffic is only watched: to record data sets and to evaluate
// predictors. `Order` is experiment::DatasetJob or experiment::LinkJob.

/// The car-following model alone.
inline experiment::ConditionSpec plain_traffic(const std::string& name) {
    experiment::ConditionSpec condition;
    condition.name = name;
    return condition;
}

/// The random draws of a job's failures.
template <class Order>
core::KeyedRandom random_of(const Order& job) {
    return core::KeyedRandom(core::StudySeed{job.study_seed}, core::Replication{job.replication});
}

/// The sensor of a failure (failures::failure_from). Throws core::InputError for an unknown failure.
std::unique_ptr<sensing::SensorModel> sensor_of(const std::string& failure, failures::Exits exits,
                                                const core::KeyedRandom& random,
                                                const sensing::SensorContext& context);

}  // namespace clearway::loop::detail
