#include "experiment/code_parts.hpp"

#include "core/files.hpp"
#include "python/part_name.hpp"
#include "python/sources.hpp"

namespace clearway::experiment {

void resolve_parts(ConditionSpec& condition, const std::filesystem::path& folder, const std::string& where) {
    condition.predictor = python::resolved(condition.predictor, folder, where + "predictor");
    for (std::string& policy : condition.policies)
        policy = python::resolved(policy, folder, where + "policy");
}

ConditionSpec located(ConditionSpec condition, const std::vector<std::filesystem::path>& folders,
                      const std::string& where) {
    condition.predictor = python::located(condition.predictor, folders, where + "predictor");
    for (std::string& policy : condition.policies)
        policy = python::located(policy, folders, where + "policy");
    if (!condition.model_file.empty())
        condition.model_file =
            python::located_file(condition.model_file, condition.model_hash, folders, where + "model",
                                 [](const auto& file) { return core::content_hash(core::read_file(file)); })
                .string();
    return condition;
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
