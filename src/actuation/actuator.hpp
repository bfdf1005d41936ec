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
#include "traffic/vehicle.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::actuation {

/// Turns leases into commands: the only place that judges feasibility (as the vehicle itself would), lets
/// leases expire, runs signal transitions (yellow, all-red, hold cap, lockout, back to the program) and
/// restores what was changed on every way out. One per run; one thread.
///
/// Of the leases for one target that cannot be carried out together (one speed, one lane, one set of links
/// that do not conflict) the one of higher priority wins, then the earlier; the others wait and are counted
/// as `outranked`. What is not feasible now is judged again at every step until its expiry, and counted once
/// for each reason:
///
/// - never legal: `expired_on_arrival`, `speed_not_finite`, `speed_negative`, `no_links`, `no_such_link`,
///   `no_such_signal`, `wrong_target`;
/// - `unreachable`: commands do not reach it now;
/// - the target is not there (any more): `vehicle_gone`, `signal_gone`, `vehicle_does_not_answer`;
/// - human drivers take no leases, only emergency vehicles pass red: `not_controllable`,
///   `not_an_emergency_vehicle`;
/// - `above_allowed_speed`: faster than road limit and vehicle allow;
/// - `cannot_stop_comfortably`: a stop that needs more than the vehicle's usual deceleration;
/// - the lane is not there for this vehicle: `on_a_junction`, `no_such_lane`, `lane_not_allowed`;
/// - `lane_does_not_continue`: neither a best lane for its route nor drivable for over 300 m;
/// - `no_room_beside`: the vehicle itself would not change now;
/// - `needs_sublane_model`: lateral positions without the sublane model;
/// - `outranked`, `hold_cap`, `lockout`: see Config;
/// - a green that cannot be granted: `no_phase_serves`; `unknown_program`, another than the network and the
///   additional files start the signal with.
///
/// A speed lease never brakes harder than the vehicle's usual deceleration: SUMO bounds the change of every
/// step while the safety checks are on.
class Actuator {
  public:
    using Config = ActuatorConfig;

    /// The network outlives the actuator.
    Actuator(const roads::Network& network, Config config);
    ~Actuator();
    Actuator(const Actuator&) = delete;
    Actuator& operator=(const Actuator&) = delete;

    /// Takes new leases and renewals. A lease of the same policy for the same target, beneficiary and kind of
    /// thing renews the running one. Leases for the `unreachable` vehicles (ordered by key) are refused, so
    /// that those running there expire.
    void accept(std::span<const traffic::Lease> leases, core::Seconds now,
                std::span<const core::VehicleKey> unreachable = {});

    /// Appends the commands for this step, ordered by vehicle key, then by signal. `snapshot` and `self` are
    /// the vehicles' knowledge of themselves. Called once for every step, in order of time.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
              const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands);

    /// Appends the commands that give back everything still held; afterwards nothing is.
    void restore_all(std::vector<traffic::Command>& commands);

    /// Number of leases in force, waiting ones included.
    std::size_t active() const;
    /// By `policy/action`.
    const std::map<std::string, LeaseCounts>& counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::actuation
