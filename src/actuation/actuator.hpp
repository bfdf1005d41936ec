#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "actuation/actuator_config.hpp"
#include "actuation/lease_counts.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
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
/// is not feasible now is judged again at every step until it expires, and is counted once per reason:
///
/// - never legal: `expired_on_arrival`, `speed_not_finite`, `speed_negative`, `no_links`, `no_such_link`,
///   `no_such_signal`, `wrong_target`;
/// - `unreachable`: commands do not reach it now; `unheard`: the message with the request was lost;
///   `outdated`: a newer request was there before it;
/// - the target does not exist (any more): `vehicle_gone`, `signal_gone`, `vehicle_does_not_answer`;
/// - human drivers take no leases unless they heed them, only emergency vehicles pass red:
/// `not_controllable`,
///   `not_an_emergency_vehicle`;
/// - `above_allowed_speed`: faster than the road limit or the vehicle allows;
/// - `cannot_stop_comfortably`: a stop that needs more than the vehicle's usual deceleration;
/// - there is no such lane for this vehicle: `on_a_junction`, `no_such_lane`, `lane_not_allowed`;
/// - `lane_does_not_continue`: neither a best lane for its route nor drivable for over 300 m;
/// - `no_room_beside`: the vehicle itself would not change now;
/// - `outranked`, `hold_cap`, `lockout`: see Config;
/// - a green that cannot be granted: `no_phase_serves`, `unknown_program` (the signal runs a program other
///   than its initial one, or SUMO's controller NEMA), `exit_phase` (the signal has one of its own);
/// - what the signal's controller is set to: `preemption_off`, `preemption_delay`, `priority` (see
///   traffic::Preemption).
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

    /// Human drivers who take leases from now on, ordered by key. At first there are none.
    void heed(std::span<const core::VehicleKey> drivers);

    /// Counts leases that never came to their targets, for a reason with static storage.
    void refuse(std::span<const traffic::Lease> leases, const char* reason);

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
    /// By `policy/action`.
    const std::map<std::string, LeaseCounts>& counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::actuation
