#pragma once

#include <string>
#include <vector>

#include "experiment/condition.hpp"

namespace clearway::experiment {

/// A built-in condition.
struct BuiltInCondition {
    std::string summary;  ///< One line for `clearway list`.
    ConditionSpec condition;
};

/// The condition that runs when none is named.
inline constexpr const char* usual_condition = "corridor";

/// `baseline`, the usual condition, the dissertation's `graph_simulation` and `graph_graphsage` with the
/// controls `b10_no_repair` and `b10_dead_reckoning`, then `solo`, the practical floor.
const std::vector<BuiltInCondition>& built_in_conditions();

/// Whether a condition has the name of a built-in one and is another: tables would give it that one's title.
bool takes_built_in_name(const ConditionSpec& condition);

/// Throws core::InputError, saying `where`, for an unknown name; it suggests the nearest name.
ConditionSpec built_in_condition(const std::string& name, const std::string& where);

}  // namespace clearway::experiment
