#pragma once

#include <cstdint>
#include <vector>

#include "core/error.hpp"
#include "experiment/condition.hpp"
#include "scenario/config.hpp"

namespace clearway::study::detail {

/// What a condition needs and its traffic model does not have: a part that needs the sublane model, or a
/// privilege of the scenario that does.
void check_traffic_model(const experiment::ConditionSpec& condition, const scenario::ScenarioConfig& scenario,
                         std::vector<core::Problem>& problems);

/// Conditions that assume mean times of other days of a scenario that names none, or names those of this
/// study's own days.
void check_mean_times(const std::vector<experiment::ConditionSpec>& conditions,
                      const scenario::ScenarioConfig& scenario, std::uint64_t study_seed,
                      std::vector<core::Problem>& problems);

/// A condition that says who answers calls, or tries units, in a study whose scenarios have none.
void check_calls(const std::vector<experiment::ConditionSpec>& conditions,
                 const std::vector<scenario::ScenarioConfig>& scenarios,
                 std::vector<core::Problem>& problems);

/// What the conditions need of the scenario's roads and do not find there: a shoulder, a gap between two
/// lanes in which an emergency vehicle fits, or the signals that are equipped. Also incidents, calls and
/// pedestrians that do not fit the roads. Builds the network if one of them needs something.
void check_roads(const std::vector<experiment::ConditionSpec>& conditions,
                 const scenario::ScenarioConfig& scenario, std::vector<core::Problem>& problems);

}  // namespace clearway::study::detail
