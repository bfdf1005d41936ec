#include "prediction/tracks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "roads/route.hpp"

namespace clearway::prediction {
namespace {

/// Below this a vehicle is taken to be where it was reported, and keeps the exact reported state.
constexpr float least_move_m = 0.01F;

void go_straight_on(traffic::MotionState& state, float distance_m) {
    state.x_m += std::cos(state.heading_rad) * distance_m;
    state.y_m += std::sin(state.heading_rad) * distance_m;
    state.lane = core::LaneIndex::none();
}

/// Moves row `row` on and notes by how much it overshot the end of its route.
void move_on(const traffic::Observation& observation, const roads::Network& network, std::size_t row,
             Tracks& tracks) {
    traffic::MotionState& state = tracks.state[row];
    const float distance_m = state.speed_mps * tracks.age_s[row];
    if (distance_m < least_move_m) return;
    const traffic::VehicleInfo* const info = tracks.info[row];
    if (info == nullptr || !info->route.exists() || !state.lane.exists()) {
        go_straight_on(state, distance_m);
        return;
    }
    const roads::Advanced advanced =
        roads::advance(network, observation.roster->route(info->route), state, core::Metres(distance_m));
    state = advanced.state;
    tracks.past_end_m[row] = static_cast<float>(advanced.past_end.value);
}

}  // namespace

std::uint32_t Tracks::row_of(core::VehicleKey vehicle) const {
    const auto found = std::ranges::lower_bound(key, vehicle);
    return static_cast<std::uint32_t>(found != key.end() && *found == vehicle ? found - key.begin()
                                                                              : std::ssize(key));
}

void Tracks::resize(std::size_t rows) {
    key.resize(rows);
    vehicle_class.resize(rows);
    info.resize(rows);
    last_x_m.resize(rows);
    last_y_m.resize(rows);
    x_m.resize(rows);
    y_m.resize(rows);
    age_s.resize(rows);
    sensor_sigma_m.resize(rows);
    last.resize(rows);
    state.resize(rows);
    past_end_m.resize(rows);
    freshness.resize(rows);
    known.resize(rows);
}

void dead_reckon(const traffic::Observation& observation, const roads::Network& network, Tracks& tracks) {
    tracks.resize(observation.vehicles.size());
    tracks.time_s = observation.time.value;
    tracks.exits_known = observation.exits_known;
    tracks.all_known = true;
    tracks.all_current = true;
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        const traffic::ObservedVehicle& vehicle = observation.vehicles[row];
        tracks.key[row] = vehicle.key;
        tracks.vehicle_class[row] = vehicle.vehicle_class;
        tracks.info[row] = observation.roster == nullptr ? nullptr : observation.roster->find(vehicle.key);
        tracks.last_x_m[row] = vehicle.state.x_m;
        tracks.last_y_m[row] = vehicle.state.y_m;
        tracks.age_s[row] = vehicle.age_s;
        tracks.sensor_sigma_m[row] = vehicle.position_sigma_m;
        tracks.last[row] = vehicle.state;
        tracks.state[row] = vehicle.state;
        tracks.past_end_m[row] = 0.0F;
        tracks.freshness[row] = vehicle.freshness;
        const bool known = vehicle.freshness == traffic::Freshness::fresh &&
                           vehicle.position_sigma_m == 0.0F && vehicle.age_s <= known_age_s;
        tracks.known[row] = known ? 1 : 0;
        tracks.all_known = tracks.all_known && known;
        tracks.all_current = tracks.all_current && vehicle.age_s == 0.0F;
        move_on(observation, network, row, tracks);
        tracks.x_m[row] = tracks.state[row].x_m;
        tracks.y_m[row] = tracks.state[row].y_m;
    }
}

}  // namespace clearway::prediction
