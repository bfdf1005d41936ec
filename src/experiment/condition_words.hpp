#pragma once

#include <string>

#include "experiment/condition.hpp"

namespace clearway::experiment {

/// What a condition's policies do, for people: `green for the emergency vehicle's approach on its arrival`. A
/// combination is told by its parts. Empty without policies, and where one is in Python.
std::string policy_words(const ConditionSpec& condition);

/// Whether something fails in a condition with policies, and yet all requests of EVs arrive.
bool loses_no_request(const ConditionSpec& condition);

/// `check_in_out sends no messages, so those that this failure loses stand for nothing`: of policies that ask
/// signals by detectors or light, where the failure loses messages to signals and no other policy sends any.
/// Empty elsewhere.
std::string unsent_words(const ConditionSpec& condition);

/// What fails in a condition: `10 % of the messages between EVs and signals lost; dark_share=0.5`. Fields
/// that were set stand as they are. Empty where nothing fails.
std::string failure_words(const ConditionSpec& condition);

}  // namespace clearway::experiment
