#include "experiment/code_parts.hpp"

#include "python/part_name.hpp"

namespace clearway::experiment {

void resolve_parts(ConditionSpec& condition, const std::filesystem::path& folder, const std::string& where) {
    condition.predictor = python::resolved(condition.predictor, folder, where + "predictor");
    for (std::string& policy : condition.policies)
        policy = python::resolved(policy, folder, where + "policy");
}

std::optional<std::string> part_called(const std::string& word) {
    return python::part_name_from(word) ? std::optional(python::short_name(word)) : std::nullopt;
}

std::vector<std::string> part_names(const ConditionSpec& condition) {
    std::vector<std::string> names;
    for (const std::string& policy : condition.policies) {
        if (const auto name = part_called(policy)) names.push_back(*name);
    }
    if (const auto name = part_called(condition.predictor)) names.push_back(*name);
    return names;
}

}  // namespace clearway::experiment
