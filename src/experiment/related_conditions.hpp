#pragma once

#include "experiment/condition.hpp"

// Conditions that belong to another: what it is compared with, and what tells where its effect comes from.
namespace clearway::experiment {

/// Whether two conditions have the same traffic model and the same settings of the environment: one of them
/// can then be the other's baseline, because only the policy and what it needs differ.
bool same_environment(const ConditionSpec& left, const ConditionSpec& right);

/// The baseline of a condition: the car-following model alone, in the same environment. It is the built-in
/// `baseline` where nothing of the environment is set.
ConditionSpec baseline_for(const ConditionSpec& condition);

/// The same policies while nothing fails and nothing is repaired. Equal to the condition where nothing fails.
/// One that is named after its content keeps that rule, another gets `_perfect` behind its name.
ConditionSpec without_failure(const ConditionSpec& condition);
/// Whether nothing fails in `other`, and it does the same as `condition`, in which something does. What is
/// repaired, names and factors do not count.
bool is_without_failure(const ConditionSpec& other, const ConditionSpec& condition);

}  // namespace clearway::experiment
