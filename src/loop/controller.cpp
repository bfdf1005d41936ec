#include "loop/controller.hpp"

#include <algorithm>

#include "experiment/settings.hpp"

namespace clearway::loop {
namespace {

/// Yellow lets a driver react and then brake, which takes longer on a slippery road (ITE's rule: reaction
/// time + speed / (2 deceleration); 3 s on a dry road).
double yellow_s(double dry_s, double friction) {
    constexpr double reaction_s = 1.0;
    constexpr double longest_s = 10.0;
    if (dry_s <= reaction_s) return dry_s;
    return std::min(longest_s, reaction_s + (dry_s - reaction_s) / friction);
}

}  // namespace

Controller make_controller(const experiment::ConditionSpec& condition, const ControllerContext& context) {
    Controller controller;
    const pipeline::ChainContext chain{.network = context.network,
                                       .random = context.random,
                                       .policy_period_s = context.loop.policy_period_s,
                                       .rules = context.loop.rules(),
                                       .guest = context.guest};
    controller.chain = std::make_unique<pipeline::DecisionChain>(condition, chain);
    controller.requests = std::make_unique<pipeline::Requests>(condition, chain);
    actuation::ActuatorConfig actuation = experiment::actuator_config(condition, {});
    actuation.yellow_s = yellow_s(actuation.yellow_s, context.friction);
    if (!context.has_pedestrians) actuation.walking_s = 0.0;
    actuation.preemption = context.preemption;
    actuation.safety_checks = condition.safety_checks;
    actuation.lateral_model = condition.traffic_model == experiment::TrafficModel::sublane
                                  ? traffic::LateralModel::sublane
                                  : traffic::LateralModel::lane;
    controller.actuator = std::make_unique<actuation::Actuator>(context.network, actuation);
    controller.greens = std::make_unique<pipeline::GreenWatch>(context.network);
    const traffic::SirenConfig siren = experiment::siren_config(condition, context.siren);
    if (siren.compliance > 0.0)
        controller.siren = std::make_unique<drivers::Siren>(context.network, context.random, siren);
    const drivers::RequestConfig requests = experiment::request_config(condition);
    if (requests.compliance > 0.0)
        controller.listeners = std::make_unique<drivers::Listeners>(context.random, requests);
    const drivers::PrivilegeConfig privilege = experiment::privilege_config(condition, context.privilege);
    if (!privilege.none())
        controller.privilege =
            std::make_unique<drivers::Privilege>(context.network, privilege, actuation.lateral_model);
    return controller;
}

sumo::Names names_of(const roads::Network& network) {
    sumo::Names names;
    for (const roads::Lane& lane : network.lanes()) {
        names.lanes.push_back(lane.id);
    }
    for (const roads::Edge& edge : network.edges()) {
        names.edges.push_back(edge.id);
    }
    for (const roads::Signal& signal : network.signals()) {
        names.signals.push_back(signal.id);
    }
    return names;
}

metrics::LeaseTotals totals_of(const Controller& controller) {
    metrics::LeaseTotals totals;
    totals.requests = controller.requests->counts();
    totals.signal_requests = controller.chain->signal_requests();
    totals.greens = controller.greens->counts();
    for (const auto& [key, counts] : controller.actuator->counts()) {
        totals.issued += counts.issued;
        totals.renewed += counts.renewed;
        totals.expired += counts.expired;
        const std::size_t slash = key.find('/');
        totals.rows.push_back({key.substr(0, slash), key.substr(slash + 1), counts.issued, counts.renewed,
                               counts.acted, counts.expired, counts.refused});
        for (const auto& [reason, refused] : counts.refused) {
            totals.refused += refused;
        }
    }
    return totals;
}

}  // namespace clearway::loop
