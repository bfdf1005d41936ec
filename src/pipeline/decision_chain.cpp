#include "pipeline/decision_chain.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

#include "experiment/equipped_signals.hpp"
#include "experiment/settings.hpp"
#include "failures/failure_config.hpp"
#include "prediction/oracle.hpp"
#include "python/part_name.hpp"

namespace clearway::pipeline {
namespace {

/// The same channels of requests with sensors that report every vehicle as it is.
failures::FailureConfig with_perfect_reports(const failures::FailureConfig& config) {
    failures::FailureConfig exact = failures::failure_from("perfect");
    const failures::RequestChannel& to_vehicles = config;
    const failures::SignalRequestChannel& to_signals = config;
    static_cast<failures::RequestChannel&>(exact) = to_vehicles;
    static_cast<failures::SignalRequestChannel&>(exact) = to_signals;
    exact.emergency_dark = config.emergency_dark;
    exact.way_loss_rate = config.way_loss_rate;
    return exact;
}

/// Twins stand for vehicles that are not known: where every vehicle is, or nobody reads the links that they
/// may add, none is driven.
core::Settings settings_for_chain(const experiment::ConditionSpec& condition,
                                  const failures::FailureConfig& failure, bool has_links) {
    core::Settings settings = experiment::predictor_settings(condition);
    const bool all_known = failure.report_interval_s == 0.0;
    const bool adds_links_alone = condition.predictor == experiment::ConditionSpec{}.predictor;
    if (adds_links_alone && (all_known || !has_links)) settings["reach_by_twin"] = "0";
    return settings;
}

}  // namespace

failures::FailureConfig observed_failure(const experiment::ConditionSpec& condition) {
    failures::FailureConfig failure = failures::failure_from(condition.failure);
    if (!prediction::knows_truth(condition.predictor)) return failure;
    failure = with_perfect_reports(failure);
    prediction::OracleConfig oracle;
    prediction::PredictionConfig shared;
    core::set_all(core::settings_of(condition.settings, condition.predictor), "predictor ", shared, oracle);
    if (oracle.place_error_m > 0.0 || oracle.age_s > 0.0) failure.report_interval_s = 0.1;
    failure.position_sigma_m = oracle.place_error_m;
    failure.latency_s = oracle.age_s;
    return failure;
}

bool has_foreign_code(const experiment::ConditionSpec& condition, const ChainContext& context) {
    const auto is_foreign = [](const std::string& part) { return python::part_name_from(part).has_value(); };
    return context.guest || is_foreign(condition.predictor) ||
           std::ranges::any_of(condition.policies, is_foreign);
}

DecisionChain::DecisionChain(const experiment::ConditionSpec& condition, const ChainContext& context)
    : equipped_(experiment::equipped_signals(condition, context.network)),
      policies_want_(experiment::reads_links(condition) || has_foreign_code(condition, context)
                         ? prediction::Want::links
                         : prediction::Want::places),
      incidents_(context.network, context.incidents),
      period_s_(context.policy_period_s) {
    assert(period_s_ > 0.0);
    const failures::FailureConfig failure = observed_failure(condition);
    if (failure.signals_known == failures::SignalsKnown::no) shown_.emplace();
    sensor_ =
        sensing::make_sensor(failure, context.random, {.network = context.network, .rules = context.rules});
    const bool has_links =
        policies_want_ == prediction::Want::links || context.readers == ChainContext::Readers::others;
    predictor_ = prediction::make_predictor(condition.predictor,
                                            {.network = context.network,
                                             .rules = context.rules,
                                             .model_file = experiment::checked_model(condition),
                                             .config = {},
                                             .random = context.random},
                                            settings_for_chain(condition, failure, has_links));
    const policy::PolicyContext place{
        .network = context.network, .period = core::Seconds(period_s_), .mean_times_s = context.mean_times_s};
    for (const std::string& name : condition.policies)
        policies_.push_back(policy::make_policy(name, place, condition.settings));
    if (context.guest) policies_.push_back(context.guest(place));
    radio_ = std::make_unique<SignalRadio>(context.network, failure, context.random);
    for (const auto& policy : policies_) {
        if (policy::SignalMessages* const talker = policy->messages()) talkers_.push_back(talker);
    }
    for (const policy::SignalMessages* const talker : talkers_)
        decided_there_.push_back(talker->part());
}

void DecisionChain::observe(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    assert(std::ranges::is_sorted(snapshot.key));
    sensor_->observe(snapshot, roster, observation_);
    incidents_.observe(snapshot, observation_);
    if (shown_) *shown_ = snapshot.signals;
    leases_.clear();
    snapshot_ = &snapshot;
}

bool DecisionChain::decision_is_due() const {
    return observation_.time.value + core::clock_tolerance_s >= static_cast<double>(decisions_) * period_s_;
}

void DecisionChain::decide(prediction::Want want) {
    assert(snapshot_ != nullptr && snapshot_->time == observation_.time);
    assert(leases_.empty() && "one decision a step");
    decisions_ = static_cast<std::uint64_t>(
                     std::floor((observation_.time.value + core::clock_tolerance_s) / period_s_)) +
                 1;
    const auto started = std::chrono::steady_clock::now();
    predictor_->predict(observation_, belief_, std::max(want, policies_want_));
    prediction_wall_time_ =
        core::Seconds(std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count());
    if (shown_) belief_.signals = *shown_;
    belief_.incidents = observation_.incidents;
    exchange_messages();
    for (const auto& policy : policies_) {
        policy->act(belief_, leases_);
    }
    std::erase_if(leases_, [&](const traffic::Lease& lease) {
        const auto* const signal = std::get_if<core::SignalIndex>(&lease.target);
        return signal != nullptr && !is_equipped(*signal);
    });
}

void DecisionChain::exchange_messages() {
    if (talkers_.empty()) return;
    wanted_.clear();
    for (const policy::SignalMessages* const talker : talkers_)
        talker->ask(belief_, wanted_);
    std::erase_if(wanted_,
                  [&](const traffic::PriorityRequest& request) { return !is_equipped(request.signal); });
    radio_->exchange(wanted_, *snapshot_);
    if (radio_->is_perfect()) return;
    for (policy::SignalMessages* const talker : talkers_)
        talker->hear(radio_->arrived());
}

void DecisionChain::answer(std::span<const traffic::SignalStatus> signals) {
    assert(snapshot_ != nullptr && std::ranges::is_sorted(signals, {}, &traffic::SignalStatus::signal));
    if (talkers_.empty()) return;
    std::vector<policy::RequestKey> open;
    if (radio_->is_perfect()) {
        for (const traffic::PriorityRequest& request : wanted_)
            open.emplace_back(request.vehicle, request.signal);
    }
    for (const policy::SignalMessages* const talker : talkers_) {
        const std::vector<policy::RequestKey> own = talker->open_requests();
        open.insert(open.end(), own.begin(), own.end());
    }
    radio_->answer(open, signals, *snapshot_);
}

}  // namespace clearway::pipeline
