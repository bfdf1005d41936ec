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
    const ConditionSpec usual;
    if (condition.failure == usual.failure) return condition;
    ConditionSpec perfect = condition;
    perfect.failure = usual.failure;
    perfect.predictor = usual.predictor;
    perfect.model_file.clear();
    perfect.model_hash.clear();
    const std::vector<std::string> present = components_of(perfect);
    std::erase_if(perfect.settings, [&](const auto& setting) {
        return std::ranges::find(present, parted(setting.first).first) == present.end();
    });
    perfect.name =
        condition.name == described_name(condition) ? described_name(perfect) : condition.name + "_perfect";
    return perfect;
}

}  // namespace clearway::experiment
