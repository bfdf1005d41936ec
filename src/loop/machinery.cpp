#include "loop/machinery.hpp"

#include "sensing/failure_config.hpp"

namespace clearway::loop {

Machinery make_machinery(const results::ConditionSpec& condition, const Surroundings& surroundings) {
    graph::LinkRules rules;
    rules.radius_m = surroundings.loop.link_radius_m;
    Machinery machinery;
    machinery.sensor = sensing::make_sensor(sensing::failure_from(condition.failure), surroundings.random,
                                            {.network = surroundings.network, .rules = rules});
    machinery.predictor = prediction::make_predictor(
        condition.predictor, {.network = surroundings.network, .rules = rules, .model_file = {}});
    for (const std::string& part : condition.parts) {
        machinery.parts.push_back(policy::make_part(part, {.network = surroundings.network}));
    }
    actuation::ActuatorConfig actuation;
    actuation.safety_checks = condition.safety_checks;
    actuation.lateral_model = condition.engine == results::Engine::sublane ? actuation::LateralModel::sublane
                                                                           : actuation::LateralModel::lane;
    machinery.actuator = std::make_unique<actuation::Actuator>(surroundings.network, actuation);
    return machinery;
}

}  // namespace clearway::loop
