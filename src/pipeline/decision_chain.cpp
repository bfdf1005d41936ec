#include "pipeline/decision_chain.hpp"

#include <cmath>

#include "experiment/settings.hpp"
#include "sensing/failure_config.hpp"

namespace clearway::pipeline {
DecisionChain::DecisionChain(const experiment::ConditionSpec& condition, const ChainContext& context)
    : period_s_(context.policy_period_s) {
    const sensing::FailureConfig failure = sensing::failure_from(condition.failure);
    if (failure.signals_known == sensing::SignalsKnown::no) shown_.emplace();
    sensor_ =
        sensing::make_sensor(failure, context.random, {.network = context.network, .rules = context.rules});
    predictor_ = prediction::make_predictor(condition.predictor,
                                            {.network = context.network,
                                             .rules = context.rules,
                                             .model_file = experiment::checked_model(condition)},
                                            core::settings_of(condition.settings, condition.predictor));
    const policy::PolicyContext place{.network = context.network, .period = core::Seconds(period_s_)};
    for (const std::string& name : condition.policies)
        policies_.push_back(policy::make_policy(name, place, condition.settings));
    if (context.guest) policies_.push_back(context.guest(place));
}

void DecisionChain::observe(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    sensor_->observe(snapshot, roster, observation_);
    if (shown_) *shown_ = snapshot.signals;
    leases_.clear();
}

bool DecisionChain::decision_is_due() const {
    return observation_.time.value + core::clock_tolerance_s >= static_cast<double>(decisions_) * period_s_;
}

void DecisionChain::decide() {
    decisions_ = static_cast<std::uint64_t>(
                     std::floor((observation_.time.value + core::clock_tolerance_s) / period_s_)) +
                 1;
    predictor_->predict(observation_, belief_);
    if (shown_) belief_.signals = *shown_;
    for (const auto& policy : policies_) {
        policy->act(belief_, leases_);
    }
}

}  // namespace clearway::pipeline
