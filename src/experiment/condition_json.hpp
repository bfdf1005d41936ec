#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/json.hpp"
#include "experiment/condition.hpp"

namespace clearway::experiment {

core::Json to_json(const ConditionSpec& condition);
ConditionSpec condition_from(const core::Json& object, const std::string& where,
                             std::vector<core::Problem>& problems);

/// What differs between two conditions of one name: `soft.py has changed`, else the keys of their JSON.
std::string what_differs(const ConditionSpec& one, const ConditionSpec& other);

}  // namespace clearway::experiment
