#include "experiment/code_parts.hpp"

#include "python/part_name.hpp"

namespace clearway::experiment {

void resolve_parts(ConditionSpec& condition, const std::filesystem::path& folder, const std::string& where) {
    condition.predictor = python::resolved(condition.predictor, folder, where + "predictor");
    for (std::string& policy : condition.policies)
        policy = python::resolved(policy, folder, where + "policy");
}

}  // namespace clearway::experiment
