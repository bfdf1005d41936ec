#include "loop/machinery.hpp"

#include <fmt/format.h>

namespace clearway::loop {

LoopConfig loop_config_of(const results::ConditionSpec& condition) {
    LoopConfig config;
    std::vector<core::Problem> problems = core::apply_settings(
        condition.loop_settings, fmt::format("condition {}: loop.", condition.name), config);
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return config;
}

Machinery make_machinery(const results::ConditionSpec& condition, const Surroundings& surroundings) {
    Machinery machinery;
    machinery.chain = std::make_unique<replay::DecisionChain>(
        condition, replay::ChainContext{.network = surroundings.network,
                                        .random = surroundings.random,
                                        .policy_period_s = surroundings.loop.policy_period_s,
                                        .link_radius_m = surroundings.loop.link_radius_m});
    actuation::ActuatorConfig actuation;
    actuation.safety_checks = condition.safety_checks;
    actuation.lateral_model = condition.engine == results::Engine::sublane ? actuation::LateralModel::sublane
                                                                           : actuation::LateralModel::lane;
    machinery.actuator = std::make_unique<actuation::Actuator>(surroundings.network, actuation);
    if (surroundings.siren.compliance > 0.0)
        machinery.siren =
            std::make_unique<drivers::Siren>(surroundings.network, surroundings.random, surroundings.siren);
    return machinery;
}

}  // namespace clearway::loop
