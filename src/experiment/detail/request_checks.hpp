#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "experiment/condition.hpp"

namespace clearway::experiment::detail {

/// Adds the problems of settings about requests that cannot have their effect together: requests that end
/// before they arrive or are sent anew, drivers who are asked while none complies, and settings of drivers
/// whom nobody asks. The settings are valid each by itself. `where` stands before each name.
void check_requests(const ConditionSpec& condition, const std::string& where,
                    std::vector<core::Problem>& problems);

}  // namespace clearway::experiment::detail
