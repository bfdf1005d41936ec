#pragma once

#include <memory>
#include <span>
#include <vector>

#include "actuation/actuator_config.hpp"
#include "actuation/lease_counts.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
#include "traffic/incident.hpp"
#include "traffic/lease.hpp"
#include "traffic/signal_status.hpp"
#include "traffic/vehicle.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::actuation {

/// Turns leases into commands. This is the only place that judges feasibility (as the vehicle itself would),
/// lets leases expire, runs signal transitions (yellow, all-red, hold cap, lockout, return to the background
/// plan) and always restores what was changed. One per run; single-threaded.
///
/// When leases for one target conflict (a target has one speed, one lane, one set of compatible links), the
/// higher priority wins, then the earlier lease; the others wait and are counted as `outranked`. A lease that
/// is not feasible now is judged again at every step until it expires, and is counted once per reason
/// (traffic::Refusal).
///
/// A speed lease never brakes harder than the vehicle's usual deceleration: while the safety checks are on,
/// SUMO limits the change per step.
class Actuator {
  public:
    using Config = ActuatorConfig;

    /// The network outlives the actuator.
    Actuator(const roads::Network& network, Config config);
    ~Actuator();
    Actuator(const Actuator&) = delete;
    Actuator& operator=(const Actuator&) = delete;

    /// Takes new leases and renewals. A lease of the same policy for the same target, beneficiary and kind of
    /// action renews the running one. Leases for `unreachable` vehicles (ordered by key) are refused, so
    /// running ones expire there.
    void accept(std::span<const traffic::Lease> leases, core::Seconds now,
                std::span<const core::VehicleKey> unreachable = {});

    /// From now on no lease sends this vehicle another way; running ones are dropped.
    void keep_way(core::VehicleKey vehicle);

    /// What is known of incidents from now on: no lease sends an emergency vehicle over a road that one
    /// closes to it, unless it is there or called there.
    void know(std::span<const traffic::KnownIncident> incidents);

    /// Human drivers who take leases from now on, ordered by key. At first there are none.
    void heed(std::span<const core::VehicleKey> drivers);

    /// Counts leases that never came to their targets.
    void refuse(std::span<const traffic::Lease> leases, traffic::Refusal reason);

    /// Appends the commands for this step: vehicles by key, then signals. `snapshot` and `self` are what
    /// vehicles know about themselves. Call once per step, in order of time.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
              const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands);

    /// Appends the commands that restore everything that is still changed. No lease is in force afterwards.
    void restore_all(std::vector<traffic::Command>& commands);

    /// Number of leases in force, waiting ones included.
    std::size_t active() const;
    /// Signals with leases in force, or not yet back in their programs and in step, by index. A signal that
    /// is missing runs its program, and a hold would begin there at once.
    std::vector<traffic::SignalStatus> signals() const;
    const LeaseLedger& counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::actuation
