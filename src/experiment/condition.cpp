#include "experiment/condition.hpp"

#include "core/json.hpp"
#include "experiment/condition_json.hpp"

namespace clearway::experiment {

std::string_view name(Engine engine) {
    switch (engine) {
        case Engine::standard:
            return "standard";
        case Engine::sublane:
            return "sublane";
        case Engine::solo:
            return "solo";
    }
    return "";
}

std::optional<Engine> engine_from(std::string_view word) {
    for (const Engine engine : {Engine::standard, Engine::sublane, Engine::solo}) {
        if (name(engine) == word) return engine;
    }
    return std::nullopt;
}

std::string_view name(traffic::SafetyChecks checks) {
    return checks == traffic::SafetyChecks::on ? "on" : "off";
}

core::Json to_json(const ConditionSpec& condition) {
    core::Json object;
    object["name"] = condition.name;
    object["failure"] = condition.failure;
    object["predictor"] = condition.predictor;
    object["parts"] = condition.parts;
    object["engine"] = experiment::name(condition.engine);
    object["safety_checks"] = experiment::name(condition.safety_checks);
    if (!condition.loop_settings.empty()) object["loop_settings"] = condition.loop_settings;
    if (condition.bluelight == traffic::BlueLight::on) object["bluelight"] = "on";
    return object;
}

ConditionSpec condition_from(const core::Json& object, const std::string& where,
                             std::vector<core::Problem>& problems) {
    ConditionSpec condition;
    core::ObjectReader reader(object, where, problems);
    reader.read("name", condition.name);
    reader.read("failure", condition.failure);
    reader.read("predictor", condition.predictor);
    reader.read("parts", condition.parts);
    reader.read_name("engine", condition.engine, engine_from);
    reader.read_name("safety_checks", condition.safety_checks, switch_from<traffic::SafetyChecks>);
    reader.read_if_there("loop_settings", condition.loop_settings);
    if (object.contains("bluelight"))
        reader.read_name("bluelight", condition.bluelight, switch_from<traffic::BlueLight>);
    return condition;
}

}  // namespace clearway::experiment
