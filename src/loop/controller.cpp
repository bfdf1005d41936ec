#include "loop/controller.hpp"

#include <cassert>

#include "experiment/settings.hpp"

namespace clearway::loop {
namespace {

pipeline::ChainContext chain_context(const ControllerContext& context) {
    return {.network = context.network,
            .random = context.random,
            .policy_period_s = context.loop.policy_period_s,
            .rules = context.loop.rules(),
            .guest = context.guest,
            .incidents = context.incidents,
            .mean_times_s = context.mean_times_s};
}

actuation::ActuatorConfig actuation_of(const experiment::ConditionSpec& condition,
                                       const ControllerContext& context) {
    actuation::ActuatorConfig config = experiment::actuator_config(condition, {});
    config.friction = context.friction;
    if (!context.has_pedestrians) config.walking_s = 0.0;
    config.preemption = context.preemption;
    config.safety_checks = condition.safety_checks;
    config.lateral_model = condition.traffic_model == experiment::TrafficModel::sublane
                               ? traffic::LateralModel::sublane
                               : traffic::LateralModel::lane;
    return config;
}

}  // namespace

Controller::Controller(const experiment::ConditionSpec& condition, const ControllerContext& context)
    : Controller(condition, context, chain_context(context), actuation_of(condition, context)) {}

Controller::Controller(const experiment::ConditionSpec& condition, const ControllerContext& context,
                       const pipeline::ChainContext& chain, const actuation::ActuatorConfig& actuation)
    : chain_(condition, chain),
      requests_(condition, chain),
      holds_({.network = context.network, .period = core::Seconds(chain.policy_period_s)}),
      actuator_(context.network, actuation),
      greens_(context.network),
      is_read_(context.is_read) {
    const traffic::SirenConfig siren = experiment::siren_config(condition, context.siren);
    if (siren.compliance > 0.0) siren_.emplace(context.network, context.random, siren);
    const drivers::RequestConfig requests = experiment::request_config(condition);
    if (requests.compliance > 0.0) listeners_.emplace(context.random, requests);
    const drivers::PrivilegeConfig privilege = experiment::privilege_config(condition, context.privilege);
    if (!privilege.none()) privilege_.emplace(context.network, privilege, actuation.lateral_model);
}

Step<Done::observed> Controller::observe(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    chain_.observe(snapshot, roster);
    return {snapshot, roster, false};
}

Step<Done::decided> Controller::decide(Step<Done::observed> step, prediction::Want want) {
    assert(step.snapshot_->time == chain_.observation().time);
    const bool is_due = (is_read_ || chain_.has_policy()) && chain_.decision_is_due();
    if (is_due) chain_.decide(want);
    return {*step.snapshot_, *step.roster_, is_due};
}

Step<Done::acted> Controller::act(Step<Done::decided> step, const truth::SelfKnowledge& self,
                                  std::vector<traffic::Command>& commands) {
    assert(commands.empty());
    const truth::Snapshot& snapshot = *step.snapshot_;
    const traffic::Roster& roster = *step.roster_;
    if (siren_) siren_->step(snapshot, roster, self, commands);
    if (privilege_) privilege_->step(snapshot, roster, commands);
    if (listeners_) actuator_.heed(listeners_->step(snapshot));
    actuator_.know(chain_.observation().incidents);
    requests_.step({chain_.leases(), chain_.unreachable(), step.has_decision(), chain_.decided_there()},
                   snapshot, roster);
    actuator_.accept(holds_.in_place_of(requests_.arrived(), chain_.belief(), step.has_decision()),
                     snapshot.time, chain_.unreachable());
    actuator_.refuse(requests_.lost(), traffic::Refusal::unheard);
    actuator_.refuse(requests_.outdated(), traffic::Refusal::outdated);
    actuator_.step(snapshot, roster, self, commands);
    return {snapshot, roster, step.has_decision()};
}

void Controller::answer(Step<Done::acted> step) {
    signals_ = actuator_.signals();
    greens_.step(signals_, *step.snapshot_, *step.roster_);
    if (step.has_decision()) chain_.answer(signals_);
}

void Controller::restore_all(std::vector<traffic::Command>& commands) {
    if (siren_) siren_->restore_all(commands);
    if (privilege_) privilege_->restore_all(commands);
    actuator_.restore_all(commands);
}

metrics::LeaseTotals Controller::totals() const {
    metrics::LeaseTotals totals;
    totals.requests = requests_.counts();
    totals.signal_requests = chain_.signal_requests();
    totals.greens = greens_.counts();
    for (const auto& [sort, counts] : actuator_.counts()) {
        totals.issued += counts.issued;
        totals.renewed += counts.renewed;
        totals.expired += counts.expired;
        totals.rows.push_back({std::string(sort.policy), sort.kind, counts.issued, counts.renewed,
                               counts.acted, counts.expired, counts.refused});
        for (const auto& [reason, refused] : counts.refused)
            totals.refused += refused;
    }
    return totals;
}

sumo::Names names_of(const roads::Network& network) {
    sumo::Names names;
    for (const roads::Lane& lane : network.lanes())
        names.lanes.push_back(lane.id);
    for (const roads::Edge& edge : network.edges())
        names.edges.push_back(edge.id);
    for (const roads::Signal& signal : network.signals())
        names.signals.push_back(signal.id);
    return names;
}

}  // namespace clearway::loop
