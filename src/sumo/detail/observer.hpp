#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "sumo/detail/fleet.hpp"
#include "sumo/detail/gateway.hpp"
#include "sumo/detail/name_table.hpp"
#include "sumo/detail/type_table.hpp"
#include "traffic/vehicle.hpp"
#include "truth/events.hpp"
#include "truth/snapshot.hpp"

namespace clearway::sumo::detail {

/// Reads state and events after each step.
///
/// - A vehicle is on the road from departure to arrival, except while it is teleported or parked.
/// - It arrived if it could have driven to its destination edge since the last reading; a vehicle that SUMO
///   takes out earlier, or during a teleport, was removed.
/// - An emergency braking begins in the step in which the deceleration d first satisfies the criterion of
///   SUMO's own warning, (d - usual) / (emergency - usual) >= 1, with the type's usual and emergency
///   deceleration.
/// - Obstacles of incidents are no vehicles: only contacts with them are reported.
/// - Two vehicles in contact are one collision while SUMO reports the contact in consecutive steps, in
///   either order. A pedestrian who walks into a standing vehicle is not a collision: in SUMO, pedestrians
///   do not see vehicles that stand on a crossing.
/// - A change of route is noticed within a second of simulated time: asking in each step would add a seventh
///   to the cost of reading, for demand that hardly ever reroutes.
class Observer {
  public:
    /// `sumo` and `names` outlive the observer.
    Observer(gateway::Sumo& sumo, const NameTable& names) : sumo_(sumo), names_(names), types_(sumo) {}

    /// Makes the vehicle with this id an emergency vehicle of this kind, whatever its type says.
    void declare_emergency(const std::string& id, traffic::VehicleKind kind) { declared_.emplace(id, kind); }

    /// Takes vehicles that are already in the simulation as known, without a departure.
    void take_present();
    /// Reads what the last step did.
    void observe(truth::Snapshot& snapshot, truth::Events& events);
    /// Reads only signals and time, before the first step.
    void observe_signals(truth::Snapshot& snapshot);

    /// Obstacles that stand on the road. SUMO does not tell when one is taken away.
    std::set<std::string>& obstacles() { return obstacles_; }

    Fleet& fleet() { return fleet_; }
    TypeTable& types() { return types_; }
    const traffic::Roster& roster() const { return roster_; }

  private:
    using Contact = std::pair<core::VehicleKey, core::VehicleKey>;

    void take_departures(truth::Events& events);
    void take_teleports(truth::Events& events);
    void take_arrivals(truth::Events& events, double step_s);
    void take_collisions(truth::Events& events);
    bool stands(const std::string& id);
    void register_vehicle(Vehicle& vehicle);
    bool reached_destination(const Vehicle& vehicle, double step_s) const;
    void take_parked();
    void read_vehicles(truth::Snapshot& snapshot, truth::Events& events);
    void list_commanded_stops(truth::Snapshot& snapshot);
    void store(Vehicle& vehicle, truth::Snapshot& snapshot);
    void look_for_oncoming_lane(Vehicle& vehicle);
    void note_braking(Vehicle& vehicle, truth::Events& events) const;
    void follow_route(Vehicle& vehicle);

    gateway::Sumo& sumo_;
    const NameTable& names_;
    Fleet fleet_;
    TypeTable types_;
    traffic::Roster roster_;
    std::unordered_map<std::string, traffic::VehicleKind> declared_;
    std::set<Contact> contacts_;
    std::set<std::string> obstacles_;
    std::map<core::VehicleKey, truth::BesideRoad> parked_;  ///< Off the road until they drive on.
    double routes_checked_s_ = 0.0;
};

}  // namespace clearway::sumo::detail
