#include "experiment/condition.hpp"

#include "core/json.hpp"
#include "experiment/condition_json.hpp"

namespace clearway::experiment {

core::Json to_json(const ConditionSpec& condition) {
    core::Json object;
    object["name"] = condition.name;
    object["failure"] = condition.failure;
    object["predictor"] = condition.predictor;
    object["policies"] = condition.policies;
    object["traffic_model"] = experiment::name(condition.traffic_model);
    object["safety_checks"] = experiment::name(condition.safety_checks);
    if (!condition.settings.empty()) object["settings"] = condition.settings;
    if (!condition.model_file.empty())
        object["model"] = {{"file", condition.model_file}, {"hash", condition.model_hash}};
    if (condition.bluelight == traffic::BlueLight::on) object["bluelight"] = "on";
    if (!condition.factors.empty()) object["factors"] = condition.factors;
    return object;
}

ConditionSpec condition_from(const core::Json& object, const std::string& where,
                             std::vector<core::Problem>& problems) {
    ConditionSpec condition;
    core::ObjectReader reader(object, where, problems);
    reader.read("name", condition.name);
    reader.read("failure", condition.failure);
    reader.read("predictor", condition.predictor);
    reader.read("policies", condition.policies);
    reader.read_name("traffic_model", condition.traffic_model, core::value_from<TrafficModel>);
    reader.read_name("safety_checks", condition.safety_checks, core::value_from<traffic::SafetyChecks>);
    reader.read_if_there("settings", condition.settings);
    if (object.contains("model")) {
        core::ObjectReader model(reader.child("model", core::Json::value_t::object), where + ": model",
                                 problems);
        model.read("file", condition.model_file);
        model.read("hash", condition.model_hash);
    }
    reader.read_if_there("factors", condition.factors);
    if (object.contains("bluelight"))
        reader.read_name("bluelight", condition.bluelight, core::value_from<traffic::BlueLight>);
    return condition;
}

}  // namespace clearway::experiment
