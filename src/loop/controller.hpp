#pragma once

#include <optional>
#include <span>
#include <vector>

#include "actuation/actuator.hpp"
#include "core/random.hpp"
#include "drivers/listeners.hpp"
#include "drivers/privilege.hpp"
#include "drivers/siren.hpp"
#include "experiment/condition.hpp"
#include "experiment/loop_config.hpp"
#include "metrics/run_metrics.hpp"
#include "pipeline/decision_chain.hpp"
#include "pipeline/green_watch.hpp"
#include "pipeline/requests.hpp"
#include "policy/timed_holds.hpp"
#include "roads/network.hpp"
#include "sumo/session.hpp"

namespace clearway::loop {

using experiment::LoopConfig;

/// What all conditions of a worker share. References outlive the controllers made from it.
struct ControllerContext {
    const roads::Network& network;
    core::KeyedRandom random{core::StudySeed{}, core::Replication{}};
    LoopConfig loop;
    drivers::SirenConfig siren;
    drivers::PrivilegeConfig privilege = {};
    double friction = 1.0;                             ///< See scenario::RoadCondition.
    bool has_pedestrians = true;                       ///< Whether there may be pedestrians.
    std::vector<traffic::Preemption> preemption = {};  ///< By signal; empty: none is set.
    policy::GuestMaker guest = {};                     ///< See pipeline::ChainContext.
    std::vector<traffic::Incident> incidents = {};
    bool is_read = false;                   ///< Whether somebody reads the belief even where no policy acts.
    std::vector<double> mean_times_s = {};  ///< See policy::PolicyContext.
};

/// How far a controller is in a step.
enum class Done : std::uint8_t { observed, decided, acted };

/// A step of a controller that is done so far. Only a controller makes one, what comes next uses it up,
/// and it refers to the snapshot and the roster of the step: so each step is observed, decided, acted and
/// answered once, in this order and about one moment, or does not compile.
template <Done>
class [[nodiscard]] Step {
  public:
    Step(Step&&) noexcept = default;
    Step& operator=(Step&&) = delete;
    /// Whether the policies were asked at this step.
    bool has_decision() const { return has_decision_; }

  private:
    friend class Controller;
    Step(const truth::Snapshot& snapshot, const traffic::Roster& roster, bool has_decision)
        : snapshot_(&snapshot), roster_(&roster), has_decision_(has_decision) {}

    const truth::Snapshot* snapshot_;
    const traffic::Roster* roster_;
    bool has_decision_;
};

/// What implements a condition: sensors, predictor and policies; the channels of requests; actuation; and the
/// drivers who react. One run; one thread.
class Controller {
  public:
    /// Throws core::InputError for unknown names and settings.
    Controller(const experiment::ConditionSpec& condition, const ControllerContext& context);

    /// Sensors see the traffic of the step.
    Step<Done::observed> observe(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    /// Policies are asked where a decision is due; `want`: what others than policies read of the belief.
    Step<Done::decided> decide(Step<Done::observed> step, prediction::Want want);
    /// Requests travel, leases become commands, drivers react: `commands` are those of the step.
    Step<Done::acted> act(Step<Done::decided> step, const truth::SelfKnowledge& self,
                          std::vector<traffic::Command>& commands);
    /// Once the commands are carried out: signals answer.
    void answer(Step<Done::acted> step);

    /// From now on no lease changes the way of this vehicle.
    void keep_way(core::VehicleKey vehicle) { actuator_.keep_way(vehicle); }
    /// From now on this vehicle's request at this signal acts from that time on, whatever its policies ask;
    /// at a time that never comes, not at all. No channel stands between.
    void hold_from(policy::RequestKey request, core::Seconds time) { holds_.hold_from(request, time); }

    /// Appends the commands that release everything that is held.
    void restore_all(std::vector<traffic::Command>& commands);
    /// What became of leases and requests.
    metrics::LeaseTotals totals() const;

    const pipeline::DecisionChain& chain() const { return chain_; }
    /// What signals do, after the last step.
    std::span<const traffic::SignalStatus> signals() const { return signals_; }

  private:
    Controller(const experiment::ConditionSpec& condition, const ControllerContext& context,
               const pipeline::ChainContext& chain, const actuation::ActuatorConfig& actuation);

    pipeline::DecisionChain chain_;
    pipeline::Requests requests_;
    policy::TimedHolds holds_;
    actuation::Actuator actuator_;
    pipeline::GreenWatch greens_;
    std::optional<drivers::Siren> siren_;          ///< Where drivers react to a siren.
    std::optional<drivers::Listeners> listeners_;  ///< Where drivers take requests.
    std::optional<drivers::Privilege> privilege_;  ///< Where emergency vehicles have privileges.
    std::vector<traffic::SignalStatus> signals_;
    bool is_read_;
};

/// The ids that a session of this network maps to indices.
sumo::Names names_of(const roads::Network& network);

}  // namespace clearway::loop
