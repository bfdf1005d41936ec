#include "analysis/condition_difference.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::analysis {

using experiment::ConditionSpec;

core::Settings values_of(const ConditionSpec& condition) {
    core::Settings values = condition.settings;
    values["failure"] = condition.failure;
    values["predictor"] = condition.predictor;
    values["policy"] = condition.policies.empty() ? "none" : core::listed(condition.policies);
    values["traffic_model"] = experiment::name(condition.traffic_model);
    values["safety_checks"] = condition.safety_checks == traffic::SafetyChecks::on ? "on" : "off";
    values["bluelight"] = condition.bluelight == traffic::BlueLight::on ? "on" : "off";
    values["rerouting_s"] = fmt::format("{:g}", condition.rerouting_s);
    values["rerouting_signal_penalty"] = fmt::format("{:g}", condition.rerouting_signal_penalty);
    values["dispatch"] = experiment::name(condition.dispatch);
    if (!condition.model_hash.empty()) values["model (content hash)"] = condition.model_hash;
    return values;
}

std::vector<ConditionDifference> condition_differences(const ConditionSpec& first,
                                                       const ConditionSpec& second) {
    const core::Settings before = values_of(first);
    const core::Settings after = values_of(second);
    const auto value = [](const core::Settings& values, const std::string& name) {
        const auto found = values.find(name);
        return found == values.end() ? std::nullopt : std::optional(found->second);
    };
    core::Settings names = before;
    names.insert(after.begin(), after.end());
    std::vector<ConditionDifference> differences;
    for (const auto& entry : names) {
        const std::string& name = entry.first;
        const std::optional<std::string> one = value(before, name);
        const std::optional<std::string> other = value(after, name);
        if (one != other) differences.push_back({second.name, name, one, other});
    }
    return differences;
}

}  // namespace clearway::analysis
