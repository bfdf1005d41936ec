#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>

#include "sumo/detail/fleet.hpp"
#include "sumo/detail/gateway.hpp"
#include "sumo/detail/name_table.hpp"
#include "traffic/command.hpp"

namespace clearway::sumo::detail {

/// Carries out commands and checks what SUMO would ignore silently.
///
/// SUMO's modes: speedMode 31 and laneChangeMode 1621 are its defaults, with every safety check.
/// - LaneChangeFreedom::strategic_only is 1537: only changes that the route demands, none for speed,
///   cooperation or the right lane; gaps of others are respected.
/// - LaneChangeFreedom::none is 1536: no changes of its own; gaps are respected and lateral alignment works.
///   SUMO's 512 would silently forbid lateral alignment too.
/// - JunctionPrivilege::pass_red is speedMode 15: the vehicle ignores red but respects right of way. The
///   type's jmDriveRedSpeed limits its speed; SUMO 1.15 cannot change that for a vehicle under way.
/// - SafetyChecks::off is speedMode 0 and laneChangeMode 0, whatever else is set.
class Commander {
  public:
    /// `sumo`, `fleet` and `names` outlive the commander.
    Commander(gateway::Sumo& sumo, Fleet& fleet, const NameTable& names, traffic::LateralModel lateral)
        : sumo_(sumo), fleet_(fleet), names_(names), lateral_(lateral), step_s_(sumo.step_length_s()) {}

    /// Throws std::invalid_argument as Session::apply does.
    void carry_out(const traffic::Command& command);
    std::uint64_t skipped() const { return skipped_; }
    std::uint64_t refused() const { return refused_; }

  private:
    void run(const traffic::SetSpeed& command);
    void run(const traffic::ReleaseSpeed& command);
    void run(const traffic::RequestLane& command);
    void run(const traffic::ReleaseLane& command);
    void run(const traffic::SetLateralAlignment& command);
    void run(const traffic::SteerSideways& command);
    void run(const traffic::SetJunctionPrivilege& command);
    void run(const traffic::SetLaneChangeFreedom& command);
    void run(const traffic::SetSafetyChecks& command);
    void run(const traffic::StopOnLane& command);
    void run(const traffic::ResumeFromStop& command);
    void run(const traffic::SetSignalState& command);
    void run(const traffic::RestoreProgram& command);
    void run(const traffic::SetRoute& command);

    /// Null, and counted, when the vehicle has left.
    Vehicle* present(core::VehicleKey key);
    /// The same also for a vehicle that is teleported or parked.
    Vehicle* on_road(core::VehicleKey key);
    const std::string& signal_name(core::SignalIndex signal) const;
    template <class Change>
    void control(core::VehicleKey key, const Change& change);
    void set_modes(const Vehicle& vehicle) const;

    gateway::Sumo& sumo_;
    Fleet& fleet_;
    const NameTable& names_;
    traffic::LateralModel lateral_;
    double step_s_;
    /// For signals that show a commanded state.
    std::unordered_map<std::string, std::string> background_programs_;
    std::uint64_t skipped_ = 0;
    std::uint64_t refused_ = 0;
};

}  // namespace clearway::sumo::detail
