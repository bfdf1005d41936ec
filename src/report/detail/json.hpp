#pragma once

#include <optional>
#include <string>

#include "analysis/estimate.hpp"
#include "analysis/summary.hpp"
#include "core/json.hpp"
#include "core/settings.hpp"

namespace clearway::report::detail {

using core::Json;
using core::to_text;

/// Null for a missing value.
inline Json json_of(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// `[10.1, 14.5]`.
inline Json json_of(const std::optional<analysis::Interval>& interval) {
    return interval ? Json{interval->low, interval->high} : Json(nullptr);
}

/// Adds both ends of an interval under their names; null where they are missing.
inline void put_ends(Json& object, const analysis::Interval* interval, const std::string& low = "low_95",
                     const std::string& high = "high_95") {
    object[low] = interval != nullptr ? Json(interval->low) : Json(nullptr);
    object[high] = interval != nullptr ? Json(interval->high) : Json(nullptr);
}

inline const analysis::Interval* pointer_to(const std::optional<analysis::Interval>& interval) {
    return interval ? &*interval : nullptr;
}

/// `{"failure.dark_share": 0.3, "condition.failure": "B5"}`: values that are numbers become JSON numbers.
inline Json factors_json(const core::Settings& factors) {
    Json object = Json::object();
    for (const auto& [name, value] : factors) {
        const auto number = core::number_from(value);
        object[name] = number ? Json(*number) : Json(value);
    }
    return object;
}

/// Sums over the complete runs, and how many of them locked.
inline Json locks_json(const analysis::ConditionSummary& condition) {
    Json object = {{"locked_runs", condition.locked_runs()}};
    for (const char* const metric :
         {"locks", "locked_vehicles", "locked_emergency_vehicles", "locked_vehicle_s"})
        object[metric] = condition.total(metric);
    return object;
}

}  // namespace clearway::report::detail
