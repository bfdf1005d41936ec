#pragma once

#include <string>
#include <vector>

#include "experiment/condition.hpp"

namespace clearway::experiment {

/// A condition that comes with Clearway.
struct BuiltInCondition {
    std::string summary;  ///< One line for `clearway list`.
    ConditionSpec condition;
};

/// The conditions of the dissertation's study and its controls: `baseline`, `graph_simulation`,
/// `graph_graphsage`, `b10_no_repair`, `b10_dead_reckoning`, then `solo`, the practical floor.
const std::vector<BuiltInCondition>& built_in_conditions();

/// Throws core::InputError, saying `where`, for an unknown name and names the nearest.
ConditionSpec built_in_condition(const std::string& name, const std::string& where);

}  // namespace clearway::experiment
