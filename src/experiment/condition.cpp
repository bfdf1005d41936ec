#include "experiment/condition.hpp"

#include "core/json.hpp"
#include "experiment/condition_json.hpp"

namespace clearway::experiment {

core::Json to_json(const ConditionSpec& condition) {
    core::Json object;
    object["name"] = condition.name;
    core::write_fields(object, condition);
    object["policies"] = condition.policies;
    if (!condition.settings.empty()) object["settings"] = condition.settings;
    if (!condition.model_file.empty())
        object["model"] = {{"file", condition.model_file}, {"hash", condition.model_hash}};
    if (!condition.factors.empty()) object["factors"] = condition.factors;
    return object;
}

ConditionSpec condition_from(const core::Json& object, const std::string& where,
                             std::vector<core::Problem>& problems) {
    ConditionSpec condition;
    core::ObjectReader reader(object, where, problems);
    reader.read("name", condition.name);
    reader.read_fields(condition);
    reader.read("policies", condition.policies);
    reader.read_if_there("settings", condition.settings);
    if (object.contains("model")) {
        core::ObjectReader model(reader.child("model", core::Json::value_t::object), where + ": model",
                                 problems);
        model.read("file", condition.model_file);
        model.read("hash", condition.model_hash);
    }
    reader.read_if_there("factors", condition.factors);
    return condition;
}

}  // namespace clearway::experiment
