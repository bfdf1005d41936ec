#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/random.hpp"
#include "experiment/condition.hpp"
#include "pipeline/signal_radio.hpp"
#include "policy/agent.hpp"
#include "policy/policy.hpp"
#include "prediction/predictor.hpp"
#include "roads/network.hpp"
#include "sensing/incident_watch.hpp"
#include "sensing/sensor.hpp"
#include "traffic/belief.hpp"
#include "traffic/lease.hpp"
#include "traffic/observation.hpp"
#include "truth/snapshot.hpp"

namespace clearway::pipeline {

/// What a chain needs besides its condition. `network` outlives the chain.
struct ChainContext {
    const roads::Network& network;
    core::KeyedRandom random{core::StudySeed{}, core::Replication{}};  ///< For the sensor failures.
    double policy_period_s = 0.5;                                      ///< Time between two decisions.
    graph::LinkRules rules = {};
    policy::GuestMaker guest = {};  ///< A policy that acts after those of the condition; may be empty.
    /// Who reads the belief of a chain: its policies alone, or somebody who may want links, too.
    enum class Readers : std::uint8_t { policies, others } readers = Readers::others;
    std::vector<traffic::Incident> incidents = {};
    std::vector<double> mean_times_s = {};  ///< See policy::PolicyContext.
};

/// What the predictor of a condition observes: its failure; for one that knows the truth, sensors without
/// faults but for the errors that its settings ask for. Throws core::InputError for unknown names.
failures::FailureConfig observed_failure(const experiment::ConditionSpec& condition);

/// Whether a policy or the predictor is a user's code.
bool has_foreign_code(const experiment::ConditionSpec& condition, const ChainContext& context);

/// Sensing, prediction and policy of a condition, in the order of a run, without a simulator. A run and its
/// replay agree because both use this class. Requests that go to signals as messages travel within it,
/// because signals decide from what they have heard; those that are leases leave it (Requests). One thread.
class DecisionChain {
  public:
    /// Throws core::InputError for unknown names and settings, and for a model that does not fit.
    DecisionChain(const experiment::ConditionSpec& condition, const ChainContext& context);

    /// Call at every step: takes the observation of the sensors. References outlive the step, and its
    /// decision and answers.
    void observe(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    /// Whether a policy period has passed since the last decision, in simulation time.
    bool decision_is_due() const;
    /// Predicts from the present observation and asks the policy. Policies for signals run at the signals,
    /// and a crew sees what its signal shows: the belief tells every policy what signals show, even when the
    /// predictor does not know it. The belief has links where they are wanted or a policy reads them.
    void decide(prediction::Want want = prediction::Want::links);

    /// Call after each decision was carried out: signals answer the requests that are open there.
    void answer(std::span<const traffic::SignalStatus> signals);

    bool has_policy() const { return !policies_.empty(); }
    const traffic::Observation& observation() const { return observation_; }
    /// Vehicles that commands cannot reach now (sensing::SensorModel).
    std::span<const core::VehicleKey> unreachable() const { return sensor_->unreachable(); }
    const prediction::Predictor& predictor() const { return *predictor_; }
    /// Belief of the last decision.
    const traffic::BelievedGraph& belief() const { return belief_; }
    /// That the belief of the last decision took.
    core::Seconds prediction_wall_time() const { return prediction_wall_time_; }
    /// Leases of the last decision; empty when no decision was made in this step.
    std::span<const traffic::Lease> leases() const { return leases_; }

    /// Policies whose leases signals decided on by themselves, from messages.
    std::span<const std::string_view> decided_there() const { return decided_there_; }
    /// What became of requests that went to signals as messages.
    const traffic::SignalRequestCounts& signal_requests() const { return radio_->counts(); }

  private:
    void exchange_messages();
    /// Whether a signal takes part in policies (`actuation.equipped`).
    bool is_equipped(core::SignalIndex signal) const { return equipped_.empty() || equipped_[signal.value]; }

    std::vector<bool> equipped_;  ///< By signal; empty: all are.

    prediction::Want policies_want_;
    std::unique_ptr<sensing::SensorModel> sensor_;
    sensing::IncidentWatch incidents_;
    std::unique_ptr<prediction::Predictor> predictor_;
    std::vector<std::unique_ptr<policy::Policy>> policies_;
    double period_s_;
    /// What signals show, for policies alone: kept when observations do not tell it.
    std::optional<traffic::SignalStates> shown_;
    std::uint64_t decisions_ = 0;
    traffic::Observation observation_;
    traffic::BelievedGraph belief_;
    core::Seconds prediction_wall_time_;
    std::vector<traffic::Lease> leases_;
    std::unique_ptr<SignalRadio> radio_;
    std::vector<policy::SignalMessages*> talkers_;  ///< Parts of `policies_`.
    std::vector<std::string_view> decided_there_;
    std::vector<traffic::PriorityRequest> wanted_;
    const truth::Snapshot* snapshot_ = nullptr;  ///< Of the present step.
};

}  // namespace clearway::pipeline
