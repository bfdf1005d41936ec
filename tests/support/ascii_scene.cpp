#include "support/ascii_scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "roads/route.hpp"
#include "support/scene_drawing.hpp"

namespace clearway::support {
namespace {

constexpr double scene_time_s = 100.0;

traffic::VehicleClass class_of(char letter) {
    if (letter == 'h') return traffic::VehicleClass::human;
    return letter == 'a' ? traffic::VehicleClass::automated : traffic::VehicleClass::emergency;
}

void set_motion(truth::Snapshot& snapshot, std::size_t row, const traffic::MotionState& state) {
    snapshot.x_m[row] = state.x_m;
    snapshot.y_m[row] = state.y_m;
    snapshot.heading_rad[row] = state.heading_rad;
    snapshot.speed_mps[row] = state.speed_mps;
    snapshot.lane[row] = state.lane;
    snapshot.lane_position_m[row] = state.lane_position_m;
    snapshot.route_edge[row] = state.route_edge;
}

traffic::MotionState motion_of(const Drawing& drawing, const Drawing::Vehicle& vehicle,
                               const roads::Network& network) {
    const std::size_t number = drawing.edges[vehicle.edge].lane_number(vehicle.row);
    const core::LaneIndex lane = *network.find_lane(fmt::format("road_{}_{}", vehicle.edge, number));
    const roads::Point point = network.point_at(lane, core::Metres(vehicle.position_m));
    return {.x_m = point.x_m,
            .y_m = point.y_m,
            .heading_rad = 0.0F,
            .speed_mps = static_cast<float>(drawing.speed_mps),
            .lane = lane,
            .lane_position_m = static_cast<float>(vehicle.position_m),
            .route_edge = static_cast<std::uint32_t>(vehicle.edge)};
}

traffic::SignalStates signal_states(const Drawing& drawing) {
    traffic::SignalStates states;
    for (const Drawing::Edge& edge : drawing.edges) {
        if (edge.letters.empty()) continue;
        std::string& state = states.state.emplace_back();
        for (std::size_t row = 0; row < drawing.rows; ++row) {
            if (edge.has_row[row]) state += edge.letters[row];
        }
        state += cross_letter(edge);
    }
    return states;
}

traffic::ObservedVehicle observed(const truth::Snapshot& snapshot, core::VehicleIndex row) {
    return {.key = snapshot.key[row],
            .vehicle_class = snapshot.vehicle_class[row],
            .state = snapshot.motion(row)};
}

traffic::BelievedVehicle believed(const truth::Snapshot& snapshot, core::VehicleIndex row) {
    return {.key = snapshot.key[row],
            .vehicle_class = snapshot.vehicle_class[row],
            .state = snapshot.motion(row)};
}

}  // namespace

Scene::Scene(std::string_view drawing_text)
    : network_([&] {
          const std::string text = network_text(parse_drawing(drawing_text));
          return roads::Network::read(folder_.write("scene.net.xml", text));
      }()) {
    Drawing drawing = parse_drawing(drawing_text);
    std::vector<core::EdgeIndex> road;
    for (std::size_t number = 0; number < drawing.edges.size(); ++number) {
        road.push_back(*network_.find_edge(fmt::format("road_{}", number)));
    }
    const core::RouteIndex route = roster_.add_route(road);
    for (const Drawing::Vehicle& vehicle : drawing.vehicles) {
        const traffic::VehicleClass vehicle_class = class_of(vehicle.id.front());
        roster_.add({.key = core::vehicle_key(vehicle.id),
                     .id = vehicle.id,
                     .vehicle_class = vehicle_class,
                     .kind = vehicle_class == traffic::VehicleClass::emergency
                                 ? traffic::VehicleKind::ambulance
                                 : traffic::VehicleKind::car,
                     .route = route});
    }
    std::ranges::sort(drawing.vehicles, {},
                      [](const auto& vehicle) { return core::vehicle_key(vehicle.id); });
    snapshot_.time = core::Seconds(scene_time_s);
    snapshot_.resize(drawing.vehicles.size());
    for (std::size_t row = 0; row < drawing.vehicles.size(); ++row) {
        const Drawing::Vehicle& vehicle = drawing.vehicles[row];
        snapshot_.key[row] = core::vehicle_key(vehicle.id);
        snapshot_.vehicle_class[row] = class_of(vehicle.id.front());
        set_motion(snapshot_, row, motion_of(drawing, vehicle, network_));
    }
    snapshot_.signals = signal_states(drawing);
}

core::VehicleKey Scene::key(const std::string& id) const {
    const core::VehicleKey key = core::vehicle_key(id);
    if (roster_.find(key) == nullptr) throw std::out_of_range("no vehicle " + id + " in this scene");
    return key;
}

core::VehicleIndex Scene::row(const std::string& id) const {
    const auto row = snapshot_.row_of(key(id));
    if (!row) throw std::out_of_range("vehicle " + id + " is not on the road");
    return *row;
}

std::string Scene::id(core::VehicleKey key) const {
    const traffic::VehicleInfo* info = roster_.find(key);
    return info == nullptr ? "?" : info->id;
}

void Scene::set_speed(const std::string& id, core::MetresPerSecond speed) {
    snapshot_.speed_mps[row(id)] = static_cast<float>(speed.value);
}

void Scene::pass(core::Seconds duration) {
    snapshot_.time += duration;
    for (core::VehicleIndex row = 0; row < snapshot_.size(); ++row) {
        const auto& route = roster_.route(roster_.find(snapshot_.key[row])->route);
        const core::Metres distance(snapshot_.speed_mps[row] * duration.value);
        set_motion(snapshot_, row, roads::advance(network_, route, snapshot_.motion(row), distance).state);
    }
}

traffic::Observation perfect_observation(const Scene& scene) {
    const truth::Snapshot& snapshot = scene.snapshot();
    traffic::Observation observation;
    observation.time = observation.report_time = snapshot.time;
    observation.is_report = true;
    observation.signals = snapshot.signals;
    observation.roster = &scene.roster();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        observation.vehicles.push_back(observed(snapshot, row));
        if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency) {
            observation.own_states.push_back(observed(snapshot, row));
        }
    }
    return observation;
}

traffic::BelievedGraph perfect_belief(const Scene& scene, const graph::LinkRules& rules) {
    const truth::Snapshot& snapshot = scene.snapshot();
    traffic::BelievedGraph belief;
    belief.time = snapshot.time;
    belief.signals = snapshot.signals;
    belief.roster = &scene.roster();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        belief.vehicles.push_back(believed(snapshot, row));
        if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency) {
            belief.own_states.push_back(believed(snapshot, row));
        }
        belief.first_link.push_back(static_cast<std::uint32_t>(belief.links.size()));
        for (core::VehicleIndex other = 0; other < snapshot.size(); ++other) {
            const float distance_m =
                std::hypot(snapshot.x_m[row] - snapshot.x_m[other], snapshot.y_m[row] - snapshot.y_m[other]);
            const bool near = distance_m < static_cast<float>(rules.radius_m);
            if (other == row || !near) continue;
            if (!rules.allows(snapshot.vehicle_class[row], snapshot.vehicle_class[other])) continue;
            belief.links.push_back({other, distance_m, 1.0F});
        }
    }
    belief.first_link.push_back(static_cast<std::uint32_t>(belief.links.size()));
    return belief;
}

}  // namespace clearway::support
