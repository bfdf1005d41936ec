#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "results/detail/json.hpp"
#include "results/unit.hpp"

namespace clearway::results::detail {

Json to_json(const ConditionSpec& condition);
ConditionSpec condition_from(const Json& object, const std::string& where,
                             std::vector<core::Problem>& problems);

}  // namespace clearway::results::detail
