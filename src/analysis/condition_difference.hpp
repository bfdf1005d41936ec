#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiment/condition.hpp"

namespace clearway::analysis {

/// Something in which two conditions of one name differ.
struct ConditionDifference {
    std::string condition;
    std::string setting;                ///< `preempt_signals.lead_s`, `failure`, `predictor`, ...
    std::optional<std::string> first;   ///< Nothing: as shipped.
    std::optional<std::string> second;  ///< Likewise.

    bool operator==(const ConditionDifference&) const = default;
};

/// Everything that decides the runs of a condition, by name: failure, predictor, policies, traffic model,
/// safety checks, blue light, model, settings.
core::Settings values_of(const experiment::ConditionSpec& condition);

/// Everything that decides runs and differs between two conditions. Their names are not compared.
std::vector<ConditionDifference> condition_differences(const experiment::ConditionSpec& first,
                                                       const experiment::ConditionSpec& second);

}  // namespace clearway::analysis
