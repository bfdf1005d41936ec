#include "experiment/related_conditions.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/folder_name.hpp"
#include "core/settings.hpp"
#include "experiment/conditions.hpp"
#include "experiment/settings.hpp"

namespace clearway::experiment {
namespace {

core::Settings environment_of(const core::Settings& settings) {
    core::Settings found;
    for (const auto& [name, value] : settings) {
        if (is_environment(parted(name).first)) found.emplace(name, value);
    }
    return found;
}

/// Nothing fails, and nothing is repaired.
ConditionSpec policies_alone(ConditionSpec condition) {
    const ConditionSpec usual;
    condition.failure = usual.failure;
    condition.predictor = usual.predictor;
    condition.model_file.clear();
    condition.model_hash.clear();
    const std::vector<std::string> present = components_of(condition);
    std::erase_if(condition.settings,
                  [&](const auto& setting) { return !core::contains(present, parted(setting.first).first); });
    return condition;
}

}  // namespace

bool same_environment(const ConditionSpec& left, const ConditionSpec& right) {
    return left.traffic_model == right.traffic_model &&
           environment_of(left.settings) == environment_of(right.settings);
}

ConditionSpec baseline_for(const ConditionSpec& condition) {
    ConditionSpec baseline = built_in_condition("baseline", "baseline");
    if (same_environment(condition, baseline)) return baseline;
    baseline.traffic_model = condition.traffic_model;
    if (condition.traffic_model != TrafficModel::standard)
        baseline.name += fmt::format("_{}", name(condition.traffic_model));
    for (const auto& [setting, value] : environment_of(condition.settings)) {
        baseline.settings.emplace(setting, value);
        baseline.name += core::as_folder_name(fmt::format("_{}_{}", parted(setting).second, value));
    }
    return baseline;
}

ConditionSpec without_failure(const ConditionSpec& condition) {
    if (condition.failure == ConditionSpec().failure) return condition;
    ConditionSpec perfect = policies_alone(condition);
    perfect.name =
        condition.name == described_name(condition) ? described_name(perfect) : condition.name + "_perfect";
    return perfect;
}

bool is_without_failure(const ConditionSpec& other, const ConditionSpec& condition) {
    const std::string usual = ConditionSpec().failure;
    if (other.failure != usual || condition.failure == usual) return false;
    if (other.policies != condition.policies) return false;  // comparing all takes its time
    ConditionSpec alike = policies_alone(other);
    const ConditionSpec perfect = policies_alone(condition);
    alike.name = perfect.name;
    alike.factors = perfect.factors;
    return alike == perfect;
}

}  // namespace clearway::experiment
