#include "loop/incidents.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "roads/closure.hpp"
#include "sensing/incident_watch.hpp"
#include "traffic/obstacle.hpp"

namespace clearway::loop {
namespace {

using traffic::VehicleClass;

/// A crew decides within this distance of the end of its edge, m.
constexpr float crew_sight_m = 100.0F;
/// It sees a block up to this far behind the end of its edge, by the queue, m.
constexpr float crew_outlook_m = 300.0F;
/// Other drivers look for another way so often, s.
constexpr double look_period_s = 1.0;
/// Draws of a driver: after the counters of drivers, one for each incident.
constexpr std::uint64_t first_draw = 64;

}  // namespace

Incidents::Incidents(const roads::Network& network, std::vector<scenario::PlacedIncident> incidents,
                     const core::KeyedRandom& random)
    : network_(&network),
      random_(random),
      cars_(network, roads::Driver::car),
      emergency_(network, roads::Driver::emergency) {
    for (scenario::PlacedIncident& placed : incidents) {
        const roads::Point place = roads::place_of(network, placed.closed);
        const bool is_closed = roads::closes_to_emergency(network, placed.closed);
        states_.push_back({.placed = std::move(placed), .place = place, .closed_to_emergency = is_closed});
    }
}

void Incidents::step(sumo::Session& session) {
    const truth::Snapshot& snapshot = session.snapshot();
    const double now_s = snapshot.time.value + core::clock_tolerance_s;
    const bool looks = now_s >= others_looked_at_s_ + look_period_s;
    if (looks) others_looked_at_s_ = snapshot.time.value;
    for (std::size_t row = 0; row < states_.size(); ++row) {
        State& state = states_[row];
        const traffic::Incident& incident = state.placed.closed;
        if (state.phase == Phase::ahead && now_s >= incident.from.value) begin(row, session);
        if (state.phase == Phase::lasting && now_s >= incident.to.value) end(row, session);
        if (state.phase != Phase::lasting) continue;
        if (!state.blocked_s) note_blocked(row, session);
        if (!state.known)
            state.known = incident.known_after ? now_s >= incident.from.value + incident.known_after->value
                                               : is_seen(state, snapshot);
        if (looks && state.known && state.placed.reroute_share > 0.0) turn_others(row, session);
    }
    turn_emergency(session);
}

metrics::IncidentCounts Incidents::counts() const {
    metrics::IncidentCounts counts{.emergency_met_s = met_s_,
                                   .emergency_turned = turned_.size(),
                                   .emergency_cut_off = cut_off_.size(),
                                   .others_rerouted = rerouted_.size()};
    for (const State& state : states_) {
        if (state.blocked_s)
            counts.delay_s =
                std::max(counts.delay_s.value_or(0.0), *state.blocked_s - state.placed.closed.from.value);
    }
    return counts;
}

bool Incidents::holds(core::VehicleKey vehicle, const sumo::Session& session) const {
    const truth::Snapshot& snapshot = session.snapshot();
    const auto at = snapshot.row_of(vehicle);
    if (!at) return false;
    const core::EdgeIndex edge = network_->lane(snapshot.lane[*at]).edge;
    const std::vector<core::EdgeIndex>& route = session.roster().route(session.roster().find(vehicle)->route);
    const std::size_t next = snapshot.route_edge[*at] + 1;
    return std::ranges::any_of(states_, [&](const State& state) {
        const traffic::Incident& incident = state.placed.closed;
        if (state.phase != Phase::lasting) return false;
        if (edge == incident.edge) return snapshot.lane_position_m[*at] <= incident.position_m;
        return next < route.size() && route[next] == incident.edge;
    });
}

std::vector<std::string> Incidents::obstacles(std::size_t row) const {
    std::vector<std::string> ids;
    for (const std::uint32_t lane : states_[row].placed.closed.lanes)
        ids.push_back(fmt::format("{}{}.{}", traffic::obstacle_prefix, row, lane));
    return ids;
}

void Incidents::begin(std::size_t row, sumo::Session& session) {
    const traffic::Incident& incident = states_[row].placed.closed;
    states_[row].phase = Phase::lasting;
    const std::vector<std::string> ids = obstacles(row);
    for (std::size_t at = 0; at < ids.size(); ++at) {
        const core::LaneIndex lane = network_->lane_of(incident.edge, incident.lanes[at]);
        if (incident.emergency_passes)
            session.close_to_others(lane);
        else
            session.add_obstacle(ids[at], lane, core::Metres(incident.position_m));
    }
    limit(incident.edge, session);
}

void Incidents::end(std::size_t row, sumo::Session& session) {
    waiting_.clear();
    const traffic::Incident& incident = states_[row].placed.closed;
    states_[row].phase = Phase::over;
    const std::vector<std::string> ids = obstacles(row);
    for (std::size_t at = 0; at < ids.size(); ++at) {
        if (incident.emergency_passes)
            session.open_again(network_->lane_of(incident.edge, incident.lanes[at]));
        else
            session.remove_obstacle(ids[at]);
    }
    limit(incident.edge, session);
}

/// The lowest limit of the incidents that last on an edge, on the lanes that each leaves open.
void Incidents::limit(core::EdgeIndex edge, sumo::Session& session) const {
    for (std::uint32_t number = 0; number < network_->edge(edge).lane_count; ++number) {
        std::optional<core::MetresPerSecond> lowest;
        for (const State& state : states_) {
            const traffic::Incident& incident = state.placed.closed;
            if (state.phase != Phase::lasting || incident.edge != edge || incident.speed_past_mps <= 0.0F ||
                std::ranges::binary_search(incident.lanes, number))
                continue;
            lowest = core::MetresPerSecond(
                std::min<double>(lowest ? lowest->value : incident.speed_past_mps, incident.speed_past_mps));
        }
        session.limit(network_->lane_of(edge, number), lowest);
    }
}

void Incidents::note_blocked(std::size_t row, const sumo::Session& session) {
    const auto stands = [&](const std::string& id) { return session.has_obstacle(id); };
    if (states_[row].placed.closed.emergency_passes || std::ranges::all_of(obstacles(row), stands))
        states_[row].blocked_s = session.time().value;
}

bool Incidents::is_seen(const State& state, const truth::Snapshot& snapshot) const {
    for (std::size_t row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != VehicleClass::human &&
            std::hypot(snapshot.x_m[row] - state.place.x_m, snapshot.y_m[row] - state.place.y_m) <=
                sensing::IncidentWatch::sight_m)
            return true;
    }
    return false;
}

void Incidents::turn_emergency(sumo::Session& session) {
    const truth::Snapshot& snapshot = session.snapshot();
    for (std::size_t row = 0; row < states_.size(); ++row) {
        if (states_[row].phase != Phase::lasting || !states_[row].closed_to_emergency) continue;
        for (core::VehicleIndex vehicle = 0; vehicle < snapshot.size(); ++vehicle) {
            if (snapshot.vehicle_class[vehicle] == VehicleClass::emergency) look_ahead(row, vehicle, session);
        }
    }
}

void Incidents::look_ahead(std::size_t row, core::VehicleIndex vehicle, sumo::Session& session) {
    const truth::Snapshot& snapshot = session.snapshot();
    const traffic::Incident& incident = states_[row].placed.closed;
    const core::VehicleKey key = snapshot.key[vehicle];
    const roads::Lane& lane = network_->lane(snapshot.lane[vehicle]);
    const std::vector<core::EdgeIndex>& route = session.roster().route(session.roster().find(key)->route);
    if (route.back() == incident.edge && expected_.contains(key)) return;
    const std::size_t next = snapshot.route_edge[vehicle] + 1;
    const float position_m = snapshot.lane_position_m[vehicle];
    if (lane.edge == incident.edge && position_m <= incident.position_m)
        met_s_.try_emplace(key, snapshot.time.value);
    if (next >= route.size() || route[next - 1] != lane.edge || lane.length_m - position_m > crew_sight_m)
        return;
    const auto ahead = route.begin() + static_cast<std::ptrdiff_t>(next);
    const auto block = std::find(ahead, route.end(), incident.edge);
    if (block == route.end()) return;
    float between_m = 0.0F;
    for (auto edge = ahead; edge != block; ++edge)
        between_m += network_->edge(*edge).length_m;
    if (between_m > crew_outlook_m) return;
    std::vector<core::EdgeIndex> later;
    if (block != ahead &&
        round_s(row, roads::Driver::emergency, {*ahead, route.back()}, later) != roads::no_way_s)
        return;  // it can turn at a later junction
    met_s_.try_emplace(key, snapshot.time.value);
    if (waiting_.contains(key)) return;
    if (send_round(row, vehicle, session)) {
        turned_.insert(key);
    } else {
        cut_off_.insert(key);
        waiting_.insert(key);
    }
}

void Incidents::turn_others(std::size_t row, sumo::Session& session) {
    const truth::Snapshot& snapshot = session.snapshot();
    for (core::VehicleIndex vehicle = 0; vehicle < snapshot.size(); ++vehicle) {
        if (snapshot.vehicle_class[vehicle] == VehicleClass::emergency) continue;
        if (turns(row, vehicle, session) && send_round(row, vehicle, session))
            rerouted_.insert(snapshot.key[vehicle]);
    }
}

bool Incidents::turns(std::size_t row, core::VehicleIndex vehicle, const sumo::Session& session) {
    State& state = states_[row];
    const truth::Snapshot& snapshot = session.snapshot();
    const core::VehicleKey key = snapshot.key[vehicle];
    const core::RouteIndex index = session.roster().find(key)->route;
    if (!passes(state, index, session.roster()) || state.decided.contains(key)) return false;
    const std::vector<core::EdgeIndex>& route = session.roster().route(index);
    const std::size_t at = snapshot.route_edge[vehicle];
    if (at >= route.size()) return false;
    const auto here = route.begin() + static_cast<std::ptrdiff_t>(at);
    const auto block = std::find(here, route.end(), state.placed.closed.edge);
    if (block == here || block == route.end()) return false;  // on it, or past it
    const double drawn = random_.uniform(core::Purpose::driver, key.value, first_draw + row);
    if (drawn >= state.placed.reroute_share) {
        state.decided.insert(key);
        return false;
    }
    const roads::Lane& lane = network_->lane(snapshot.lane[vehicle]);
    const float left_m = lane.length_m - snapshot.lane_position_m[vehicle];
    if (lane.edge != *here || (left_m < roads::turn_room_m && block != here + 1))
        return false;  // on the next edge
    state.decided.insert(key);
    return true;
}

bool Incidents::send_round(std::size_t row, core::VehicleIndex vehicle, sumo::Session& session) {
    const truth::Snapshot& snapshot = session.snapshot();
    const core::VehicleKey key = snapshot.key[vehicle];
    const bool is_emergency = snapshot.vehicle_class[vehicle] == VehicleClass::emergency;
    const roads::Driver driver = is_emergency ? roads::Driver::emergency : roads::Driver::car;
    const std::vector<core::EdgeIndex>& route = session.roster().route(session.roster().find(key)->route);
    traffic::SetRoute command{key, {}};
    const roads::Trip trip{network_->lane(snapshot.lane[vehicle]).edge, route.back()};
    if (roads::passes_its_end(std::span(route).subspan(snapshot.route_edge[vehicle])) ||
        round_s(row, driver, trip, command.edges) == roads::no_way_s)
        return false;
    const std::uint64_t refused = session.refused_commands();
    const traffic::Command sent = std::move(command);
    session.apply({&sent, 1});
    return session.refused_commands() == refused;
}

double Incidents::round_s(std::size_t row, roads::Driver driver, const roads::Trip& trip,
                          std::vector<core::EdgeIndex>& way) {
    const bool is_emergency = driver == roads::Driver::emergency;
    // A search keeps a tree for each destination; other drivers have many.
    constexpr std::uint32_t most_trees = 64;
    if (!is_emergency && ++searches_ % most_trees == 0) cars_ = roads::RouteSearch(*network_, driver);
    roads::RouteSearch& search = is_emergency ? emergency_ : cars_;
    const auto edge_s = [&](core::EdgeIndex edge, double) {
        return is_closed(edge, row, driver) ? roads::no_way_s : search.free_s(edge);
    };
    return search.search(trip, edge_s, way);
}

bool Incidents::passes(State& state, core::RouteIndex route, const traffic::Roster& roster) const {
    if (route.value >= state.passes.size()) state.passes.resize(roster.route_count(), 0);
    std::uint8_t& known = state.passes[route.value];
    if (known == 0) known = !core::contains(roster.route(route), state.placed.closed.edge) ? 1 : 2;
    return known == 2;
}

bool Incidents::is_closed(core::EdgeIndex edge, std::size_t row, roads::Driver driver) const {
    for (std::size_t other = 0; other < states_.size(); ++other) {
        const State& state = states_[other];
        if (state.placed.closed.edge != edge || state.phase != Phase::lasting) continue;
        if (other != row && !state.known) continue;
        if (driver == roads::Driver::car || state.closed_to_emergency) return true;
    }
    return false;
}

}  // namespace clearway::loop
