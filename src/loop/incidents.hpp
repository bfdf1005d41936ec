#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "metrics/incident_counts.hpp"
#include "roads/network.hpp"
#include "roads/route_search.hpp"
#include "scenario/incident.hpp"
#include "sumo/session.hpp"

namespace clearway::loop {

/// Blocks the roads of a simulation as its incidents say, and lets those react who do so in every condition.
///
/// - A vehicle stands on each closed lane, as soon as there is room; or, where emergency vehicles pass, the
///   lanes are closed to all others.
/// - A share of the other drivers, drawn by vehicle, takes the fastest way by free flow round an incident
///   that is known: at the time that the scenario sets or, without one, once an automated or emergency
///   vehicle was within sight of it, whatever its sensor. Whom it cuts off stays.
/// - The crew of an emergency vehicle sees a block up to 300 m behind the end of its edge. Within 100 m of
/// the
///   last junction from which another way leads, it takes the fastest one by free flow.
///
/// A value: a forked child continues with its copy. The network outlives it. One thread.
class Incidents {
  public:
    Incidents(const roads::Network& network, std::vector<scenario::PlacedIncident> incidents,
              const core::KeyedRandom& random);

    /// Once after each step of the simulation, with the session of that step.
    void step(sumo::Session& session);
    /// Whether a vehicle on the road is on the way to a block on its edge, or at the end of the edge before:
    /// a reason to stand.
    bool holds(core::VehicleKey vehicle, const sumo::Session& session) const;
    /// A vehicle that is called to the road that an incident closes: its crew does not turn there.
    void expect(core::VehicleKey vehicle) { expected_.insert(vehicle); }
    metrics::IncidentCounts counts() const;

  private:
    enum class Phase : std::uint8_t { ahead, lasting, over };
    struct State {
        scenario::PlacedIncident placed;
        roads::Point place;
        bool closed_to_emergency = false;
        Phase phase = Phase::ahead;
        bool known = false;                       ///< To other drivers.
        std::optional<double> blocked_s = {};     ///< When all its lanes were.
        std::vector<std::uint8_t> passes = {};    ///< By route: 0 not looked at, 1 no, 2 yes.
        std::set<core::VehicleKey> decided = {};  ///< Other drivers.
    };

    std::vector<std::string> obstacles(std::size_t row) const;
    void begin(std::size_t row, sumo::Session& session);
    void end(std::size_t row, sumo::Session& session);
    void limit(core::EdgeIndex edge, sumo::Session& session) const;
    void note_blocked(std::size_t row, const sumo::Session& session);
    bool is_seen(const State& state, const truth::Snapshot& snapshot) const;
    void turn_emergency(sumo::Session& session);
    void look_ahead(std::size_t row, core::VehicleIndex vehicle, sumo::Session& session);
    /// The fastest way by free flow from an edge to another round an incident and those that are known.
    double round_s(std::size_t row, roads::Driver driver, const roads::Trip& trip,
                   std::vector<core::EdgeIndex>& way);
    void turn_others(std::size_t row, sumo::Session& session);
    /// Whether a driver would take another way, and has not been asked before, at a place where it can.
    bool turns(std::size_t row, core::VehicleIndex vehicle, const sumo::Session& session);
    /// Sends a vehicle round an incident. Returns whether there is a way that SUMO knows.
    bool send_round(std::size_t row, core::VehicleIndex vehicle, sumo::Session& session);
    bool passes(State& state, core::RouteIndex route, const traffic::Roster& roster) const;
    /// Whether an edge is none for somebody who sees this incident and knows those that are known.
    bool is_closed(core::EdgeIndex edge, std::size_t row, roads::Driver driver) const;

    const roads::Network* network_;
    core::KeyedRandom random_;
    std::vector<State> states_;
    roads::RouteSearch cars_, emergency_;
    double others_looked_at_s_ = -1.0;
    std::map<core::VehicleKey, double> met_s_;  ///< When they first came to a block.
    std::set<core::VehicleKey> turned_, cut_off_, rerouted_, expected_;
    std::set<core::VehicleKey> waiting_;  ///< Those cut off who look again when an incident is over.
    std::uint32_t searches_ = 0;
};

}  // namespace clearway::loop
