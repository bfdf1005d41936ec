#include "sumo/detail/observer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "traffic/obstacle.hpp"

namespace clearway::sumo::detail {
namespace {

constexpr double route_check_period_s = 1.0;
/// No road vehicle accelerates harder; limits how far one gets in a step.
constexpr double acceleration_bound_mps2 = 10.0;
/// SUMO's tolerance in its criterion for emergency braking.
constexpr float braking_tolerance_mps2 = 0.001F;

/// SUMO counts degrees clockwise from north.
float heading_rad(double angle_deg) {
    constexpr double pi = std::numbers::pi;
    return static_cast<float>(std::remainder(pi / 2.0 - angle_deg * pi / 180.0, 2.0 * pi));
}

bool is_internal(const std::string& lane) {
    return lane.starts_with(':');
}

bool is_obstacle(const std::string& id) {
    return id.starts_with(traffic::obstacle_prefix);
}

/// SUMO tells no lane of a vehicle beside the road: it is the last one known.
truth::BesideRoad beside_road(const Vehicle& vehicle) {
    const gateway::VehicleReading& reading = vehicle.reading;
    return {.key = vehicle.key,
            .vehicle_class = vehicle.vehicle_class,
            .state = {.x_m = static_cast<float>(reading.x_m),
                      .y_m = static_cast<float>(reading.y_m),
                      .heading_rad = heading_rad(reading.angle_deg),
                      .lane = vehicle.lane,
                      .lane_position_m = vehicle.lane_position_m,
                      .route_edge = vehicle.route_edge}};
}

}  // namespace

void Observer::observe(truth::Snapshot& snapshot, truth::Events& events) {
    const double now_s = sumo_.time_s();
    const double step_s = now_s - snapshot.time.value;
    assert(step_s > 0.0);
    snapshot.time = core::Seconds(now_s);
    events.clear();
    events.time = snapshot.time;
    take_departures(events);
    take_teleports(events);
    take_arrivals(events, step_s);
    take_parked();
    read_vehicles(snapshot, events);
    take_collisions(events);
    observe_signals(snapshot);
}

void Observer::take_present() {
    for (const std::string& id : sumo_.vehicle_ids()) {
        Vehicle& vehicle = fleet_.insert(id);
        register_vehicle(vehicle);
        fleet_.put_on_road(vehicle);
    }
}

void Observer::observe_signals(truth::Snapshot& snapshot) {
    snapshot.time = core::Seconds(sumo_.time_s());
    const std::vector<std::string>& signals = names_.names().signals;
    snapshot.signals.state.resize(signals.size());
    for (std::size_t i = 0; i < signals.size(); ++i) {
        snapshot.signals.state[i] = sumo_.signal_state(signals[i]);
    }
}

void Observer::take_departures(truth::Events& events) {
    for (const std::string& id : sumo_.departed()) {
        if (is_obstacle(id)) {
            obstacles_.insert(id);
            continue;
        }
        Vehicle& vehicle = fleet_.insert(id);
        register_vehicle(vehicle);
        fleet_.put_on_road(vehicle);
        events.departed.push_back(vehicle.key);
    }
}

void Observer::take_teleports(truth::Events& events) {
    for (const std::string& id : sumo_.teleports_started()) {
        Vehicle* vehicle = fleet_.find(id);
        if (vehicle == nullptr) continue;
        fleet_.take_off_road(*vehicle);
        events.teleported.push_back(vehicle->key);
    }
    for (const std::string& id : sumo_.teleports_ended()) {
        Vehicle* vehicle = fleet_.find(id);
        if (vehicle != nullptr) fleet_.put_on_road(*vehicle);
    }
}

void Observer::take_arrivals(truth::Events& events, double step_s) {
    for (const std::string& id : sumo_.arrived()) {
        const Vehicle* vehicle = fleet_.find(id);
        const bool arrived = vehicle != nullptr && reached_destination(*vehicle, step_s);
        (arrived ? events.arrived : events.removed).push_back(core::vehicle_key(id));
        fleet_.erase(id);
    }
}

bool Observer::reached_destination(const Vehicle& vehicle, double step_s) const {
    if (!vehicle.on_road) return false;
    const std::vector<core::EdgeIndex>& route = roster_.route(roster_.find(vehicle.key)->route);
    const double reach_m = (vehicle.speed_mps + acceleration_bound_mps2 * step_s) * step_s + 1.0;
    double ahead_m = 0.0;
    if (vehicle.route_edge + 1 < route.size() && !is_internal(vehicle.lane_id))
        ahead_m = sumo_.lane_length_m(vehicle.lane_id) - vehicle.lane_position_m;
    for (std::size_t i = vehicle.route_edge + 1; i + 1 < route.size(); ++i) {
        ahead_m += sumo_.lane_length_m(names_.names().edges[route[i].value] + "_0");
    }
    return ahead_m <= reach_m;
}

void Observer::take_collisions(truth::Events& events) {
    std::set<Contact> contacts;
    for (const gateway::CollisionReport& report : sumo_.collisions()) {
        const core::VehicleKey collider = core::vehicle_key(report.collider);
        const core::VehicleKey victim = core::vehicle_key(report.victim);
        const Contact contact = std::minmax(collider, victim);
        const bool with_obstacle = is_obstacle(report.victim) || is_obstacle(report.collider);
        if (!with_obstacle && roster_.find(victim) == nullptr && stands(report.collider)) continue;
        if (!contacts.insert(contact).second || contacts_.contains(contact)) continue;
        const auto is_emergency = [&](core::VehicleKey key) {
            const traffic::VehicleInfo* info = roster_.find(key);
            return info != nullptr && info->vehicle_class == traffic::VehicleClass::emergency;
        };
        events.collisions.push_back(
            {.collider = collider,
             .victim = victim,
             .place = with_obstacle              ? truth::CollisionPlace::obstacle
                      : is_internal(report.lane) ? truth::CollisionPlace::junction
                                                 : truth::CollisionPlace::lane,
             .lane = names_.lane(report.lane),
             .with_emergency_vehicle = is_emergency(collider) || is_emergency(victim)});
    }
    contacts_ = std::move(contacts);
}

bool Observer::stands(const std::string& id) {
    constexpr float standing_mps = 0.1F;  // SUMO's own limit for halting
    const Vehicle* vehicle = fleet_.find(id);
    return vehicle != nullptr && vehicle->speed_mps < standing_mps;
}

void Observer::register_vehicle(Vehicle& vehicle) {
    const VehicleType& type = types_.get(sumo_.type_of(vehicle.id));
    const gateway::TypeReading& dynamics = type.dynamics;
    assert(!vehicle.on_road && dynamics.length_m > 0.0 && dynamics.deceleration_mps2 > 0.0);
    const auto declared = declared_.find(vehicle.id);
    const bool is_declared = declared != declared_.end();
    vehicle.vehicle_class = is_declared ? traffic::VehicleClass::emergency : type.vehicle_class;
    vehicle.deceleration_mps2 = static_cast<float>(dynamics.deceleration_mps2);
    vehicle.emergency_deceleration_mps2 = static_cast<float>(dynamics.emergency_deceleration_mps2);
    vehicle.route_id = sumo_.route_id(vehicle.id);
    roster_.add({.key = vehicle.key,
                 .id = vehicle.id,
                 .vehicle_class = vehicle.vehicle_class,
                 .kind = is_declared ? declared->second : type.kind,
                 .length_m = static_cast<float>(dynamics.length_m),
                 .width_m = static_cast<float>(dynamics.width_m),
                 .minimum_gap_m = static_cast<float>(dynamics.minimum_gap_m),
                 .maximum_speed_mps = static_cast<float>(dynamics.maximum_speed_mps),
                 .acceleration_mps2 = static_cast<float>(dynamics.acceleration_mps2),
                 .deceleration_mps2 = vehicle.deceleration_mps2,
                 .speed_factor = static_cast<float>(sumo_.speed_factor(vehicle.id)),
                 .route = roster_.add_route(names_.edges(sumo_.route_edges(vehicle.id)))});
}

void Observer::take_parked() {
    std::erase_if(parked_, [this](const auto& parked) {
        Vehicle* vehicle = fleet_.find(parked.first);
        if (vehicle == nullptr) return true;
        if (sumo_.read(vehicle->id, vehicle->reading) != gateway::Presence::on_road) return false;
        fleet_.put_on_road(*vehicle);
        return true;
    });
}

void Observer::read_vehicles(truth::Snapshot& snapshot, truth::Events& events) {
    const bool check_routes = snapshot.time.value - routes_checked_s_ >= route_check_period_s;
    if (check_routes) routes_checked_s_ = snapshot.time.value;
    std::vector<Vehicle*> gone;
    do {
        for (Vehicle* vehicle : std::exchange(gone, {}))
            fleet_.take_off_road(*vehicle);
        fleet_.number_rows();
        snapshot.resize(fleet_.rows().size());
        for (Vehicle* vehicle : fleet_.on_road()) {
            const gateway::Presence presence = sumo_.read(vehicle->id, vehicle->reading);
            if (presence == gateway::Presence::parked) parked_[vehicle->key] = beside_road(*vehicle);
            if (presence != gateway::Presence::on_road) {
                gone.push_back(vehicle);
                continue;
            }
            if (check_routes || vehicle->route_id.empty()) follow_route(*vehicle);
            store(*vehicle, snapshot);
            note_braking(*vehicle, events);
        }
        // SUMO reports a removal after a collision one step late: the rows are read again without the
        // vehicle.
    } while (!gone.empty());
    snapshot.beside_road.clear();
    for (const auto& [key, parked] : parked_)
        snapshot.beside_road.push_back(parked);
    list_commanded_stops(snapshot);
}

void Observer::list_commanded_stops(truth::Snapshot& snapshot) {
    snapshot.commanded_stops.clear();
    const auto stands_at_own = [&](const Vehicle& vehicle) {
        if (!vehicle.controls.own_stop || !sumo_.is_stopped(vehicle.id)) return false;
        return sumo_.stops(vehicle.id).front() == *vehicle.controls.own_stop;
    };
    for (const Vehicle* vehicle : fleet_.rows())
        if (stands_at_own(*vehicle)) snapshot.commanded_stops.push_back(vehicle->key);
    for (const auto& [key, parked] : parked_) {
        const Vehicle* const vehicle = fleet_.find(key);
        if (vehicle != nullptr && stands_at_own(*vehicle)) snapshot.commanded_stops.push_back(key);
    }
}

void Observer::store(Vehicle& vehicle, truth::Snapshot& snapshot) {
    const gateway::VehicleReading& reading = vehicle.reading;
    if (reading.lane != vehicle.lane_id) {
        vehicle.lane = names_.lane(reading.lane);
        vehicle.lane_id = reading.lane;
        vehicle.route_edge = sumo_.route_index(vehicle.id);
        look_for_oncoming_lane(vehicle);
    }
    vehicle.lane_position_m = static_cast<float>(
        vehicle.opposite_of_m ? *vehicle.opposite_of_m - reading.lane_position_m : reading.lane_position_m);
    vehicle.speed_mps = static_cast<float>(reading.speed_mps);
    const std::uint32_t row = vehicle.row;
    assert(vehicle.on_road && row < snapshot.size());
    snapshot.key[row] = vehicle.key;
    snapshot.vehicle_class[row] = vehicle.vehicle_class;
    snapshot.x_m[row] = static_cast<float>(reading.x_m);
    snapshot.y_m[row] = static_cast<float>(reading.y_m);
    snapshot.heading_rad[row] = heading_rad(reading.angle_deg);
    snapshot.speed_mps[row] = vehicle.speed_mps;
    snapshot.acceleration_mps2[row] = static_cast<float>(reading.acceleration_mps2);
    snapshot.lane[row] = vehicle.lane;
    snapshot.lane_position_m[row] = vehicle.lane_position_m;
    snapshot.route_edge[row] = vehicle.route_edge;
}

/// A vehicle that overtakes on the lane of oncoming traffic counts as on the lane beside it, in its own
/// direction: lanes and positions mean the way it drives. Its point on the plane is where it is.
void Observer::look_for_oncoming_lane(Vehicle& vehicle) {
    vehicle.opposite_of_m.reset();
    if (is_internal(vehicle.lane_id)) return;
    const std::vector<core::EdgeIndex>& known = roster_.route(roster_.find(vehicle.key)->route);
    const std::string edge = vehicle.lane_id.substr(0, vehicle.lane_id.rfind('_'));
    if (vehicle.route_edge < known.size() && names_.names().edges[known[vehicle.route_edge].value] == edge)
        return;
    const std::vector<std::string> route = sumo_.route_edges(vehicle.id);
    if (vehicle.route_edge >= route.size() || route[vehicle.route_edge] == edge) return;
    const std::string& own = route[vehicle.route_edge];
    vehicle.lane = names_.lane(own + "_" + std::to_string(sumo_.lane_count(own) - 1));
    vehicle.opposite_of_m = sumo_.lane_length_m(vehicle.lane_id);
}

void Observer::note_braking(Vehicle& vehicle, truth::Events& events) const {
    const auto deceleration_mps2 = static_cast<float>(-vehicle.reading.acceleration_mps2);
    const float beyond_usual_mps2 = deceleration_mps2 - vehicle.deceleration_mps2;
    const float reserve_mps2 =
        std::max(braking_tolerance_mps2, vehicle.emergency_deceleration_mps2 - vehicle.deceleration_mps2);
    const bool is_hard = beyond_usual_mps2 > braking_tolerance_mps2 &&
                         beyond_usual_mps2 + braking_tolerance_mps2 >= reserve_mps2;
    if (is_hard && !vehicle.braking_hard)
        events.emergency_brakings.push_back({vehicle.key, deceleration_mps2});
    vehicle.braking_hard = is_hard;
}

void Observer::follow_route(Vehicle& vehicle) {
    std::string route = sumo_.route_id(vehicle.id);
    if (route == vehicle.route_id) return;
    vehicle.route_id = std::move(route);
    vehicle.route_edge = sumo_.route_index(vehicle.id);
    roster_.set_route(vehicle.key, roster_.add_route(names_.edges(sumo_.route_edges(vehicle.id))));
}

}  // namespace clearway::sumo::detail
