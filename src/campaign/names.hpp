#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "experiment/condition.hpp"

namespace clearway::campaign {

/// The problem of a `name` at `where` that is not in `known`; lists them, if they are few, and suggests the
/// nearest. `listed_by` is the command that describes them.
core::Problem unknown_name(const std::string& where, const std::string& name,
                           const std::vector<std::string>& known,
                           const std::string& listed_by = "clearway list");

std::vector<std::string> failure_names();

/// Adds the problems of a failure given at `where`: a preset or fields (failures::failure_from).
void check_failure(const std::string& where, const std::string& failure,
                   std::vector<core::Problem>& problems);

/// Checks failure, predictor, policies, settings and model of every condition before anything runs. Throws
/// core::InputError with every problem.
void check_names(const std::vector<experiment::ConditionSpec>& conditions);

}  // namespace clearway::campaign
