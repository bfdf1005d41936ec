#include "policy/detail/view.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "roads/way_ahead.hpp"

namespace clearway::policy::detail {
namespace {

/// Vehicles on a way ahead that need one allocation.
constexpr std::size_t usually_ahead = 32;

}  // namespace

roads::Route View::route_of(core::VehicleKey vehicle) const {
    const traffic::VehicleInfo* info = belief_.roster->find(vehicle);
    if (info == nullptr || !info->route.exists()) return {};
    return belief_.roster->route(info->route);
}

bool View::is_on_route(const traffic::BelievedVehicle& vehicle) const {
    if (!vehicle.state.lane.exists()) return false;
    const roads::Route route = route_of(vehicle.key);
    if (vehicle.state.route_edge >= route.size()) return false;
    const roads::Edge& edge = network_.edge(network_.lane(vehicle.state.lane).edge);
    return edge.internal || network_.lane(vehicle.state.lane).edge == route[vehicle.state.route_edge];
}

std::vector<traffic::BelievedVehicle> View::emergency_vehicles() const {
    assert(std::ranges::is_sorted(belief_.own_states, {}, &traffic::BelievedVehicle::key));
    std::vector<traffic::BelievedVehicle> found;
    found.reserve(belief_.own_states.size());
    for (const traffic::BelievedVehicle& own : belief_.own_states) {
        if (is_on_route(own)) found.push_back(own);
    }
    for (const traffic::BelievedVehicle& vehicle : belief_.vehicles) {
        if (vehicle.vehicle_class != traffic::VehicleClass::emergency || !is_on_route(vehicle)) continue;
        const bool knows_itself =
            std::ranges::binary_search(belief_.own_states, vehicle.key, {}, &traffic::BelievedVehicle::key);
        if (!knows_itself) found.push_back(vehicle);
    }
    std::ranges::sort(found, {}, &traffic::BelievedVehicle::key);
    return found;
}

const traffic::VehicleInfo& View::info_of(const traffic::BelievedVehicle& vehicle) const {
    static const traffic::VehicleInfo typical;
    const traffic::VehicleInfo* const info = belief_.roster->find(vehicle.key);
    return info != nullptr ? *info : typical;
}

core::MetresPerSecond View::allowed_speed(const traffic::BelievedVehicle& vehicle) const {
    const traffic::VehicleInfo* info = belief_.roster->find(vehicle.key);
    if (info == nullptr || !vehicle.state.lane.exists()) return {};
    const float by_road = network_.lane(vehicle.state.lane).speed_limit_mps * info->speed_factor;
    return core::MetresPerSecond(std::min(by_road, info->maximum_speed_mps));
}

std::optional<core::EdgeIndex> View::edge_of(const traffic::BelievedVehicle& vehicle) const {
    if (!vehicle.state.lane.exists()) return std::nullopt;
    return network_.lane(vehicle.state.lane).edge;
}

std::vector<VehicleAhead> View::vehicles_ahead(const traffic::BelievedVehicle& vehicle,
                                               core::Metres horizon) const {
    assert(is_on_route(vehicle) && horizon.value >= 0.0);
    std::vector<VehicleAhead> ahead;
    std::optional<roads::WayAhead> way;
    const auto reach = static_cast<float>(horizon.value);
    for (const traffic::BelievedVehicle& other : belief_.vehicles) {
        // No path is shorter than a straight line; this is decided at once for most vehicles.
        if (std::abs(other.state.x_m - vehicle.state.x_m) > reach ||
            std::abs(other.state.y_m - vehicle.state.y_m) > reach)
            continue;
        if (other.key == vehicle.key || !other.state.lane.exists()) continue;
        if (!way) way.emplace(network_, route_of(vehicle.key), vehicle.state, horizon);
        const auto distance = way->distance_to(other.state);
        if (!distance) continue;
        if (ahead.empty()) ahead.reserve(usually_ahead);
        ahead.push_back({&other, distance->value});
    }
    std::ranges::sort(ahead, {},
                      [](const VehicleAhead& one) { return std::pair(one.distance_m, one.vehicle); });
    return ahead;
}

std::vector<VehicleAhead> View::vehicles_behind(const traffic::BelievedVehicle& vehicle,
                                                core::Metres reach) const {
    assert(is_on_route(vehicle) && reach.value >= 0.0);
    std::vector<VehicleAhead> behind;
    const roads::Route route = route_of(vehicle.key);
    const auto near = static_cast<float>(reach.value);
    const auto passed = route.first(std::min<std::size_t>(route.size(), vehicle.state.route_edge + 1));
    for (const traffic::BelievedVehicle& other : belief_.vehicles) {
        if (std::abs(other.state.x_m - vehicle.state.x_m) > near ||
            std::abs(other.state.y_m - vehicle.state.y_m) > near)
            continue;
        if (other.key == vehicle.key || !other.state.lane.exists()) continue;
        const auto edge = std::ranges::find(passed, network_.lane(other.state.lane).edge);
        if (edge == passed.end()) continue;
        traffic::MotionState on_route = other.state;
        on_route.route_edge = static_cast<std::uint32_t>(std::distance(passed.begin(), edge));
        const auto distance = roads::distance_ahead(network_, route, on_route, vehicle.state, reach);
        if (distance && distance->value > 0.0) behind.push_back({&other, -distance->value});
    }
    std::ranges::stable_sort(behind, std::ranges::greater{}, &VehicleAhead::distance_m);
    return behind;
}

bool View::may_use_lane(const traffic::BelievedVehicle& vehicle, std::uint32_t number) const {
    if (!is_on_route(vehicle)) return false;
    const core::EdgeIndex edge_index = network_.lane(vehicle.state.lane).edge;
    const roads::Edge& edge = network_.edge(edge_index);
    if (edge.internal || number >= edge.lane_count) return false;
    const core::LaneIndex lane = network_.lane_of(edge_index, number);
    const bool is_emergency = vehicle.vehicle_class == traffic::VehicleClass::emergency;
    if (!(is_emergency ? network_.lane(lane).allows_emergency : network_.lane(lane).allows_cars))
        return false;
    const roads::Route route = route_of(vehicle.key);
    const core::Metres to_end = roads::distance_to_end(network_, route, vehicle.state);
    const core::Metres position(vehicle.state.lane_position_m);
    const core::Metres carried =
        roads::drivable(network_, route, vehicle.state.route_edge, lane, position, core::Metres(1000.0));
    return carried > roads::worth_following || carried.value >= to_end.value - 1.0;
}

std::vector<std::uint32_t> View::usable_neighbours(const traffic::BelievedVehicle& vehicle) const {
    std::vector<std::uint32_t> usable;
    const std::uint32_t number = lane_number(vehicle);
    if (number > 0 && may_use_lane(vehicle, number - 1)) usable.push_back(number - 1);
    if (may_use_lane(vehicle, number + 1)) usable.push_back(number + 1);
    return usable;
}

std::optional<std::uint32_t> View::way_out(const traffic::BelievedVehicle& vehicle,
                                           const std::vector<VehicleAhead>& others,
                                           double side_room_m) const {
    const traffic::MotionState& own = vehicle.state;
    std::optional<std::uint32_t> best;
    long fewest = 0;
    for (const std::uint32_t number : usable_neighbours(vehicle)) {
        const core::LaneIndex lane = network_.lane_of(*edge_of(vehicle), number);
        const long beside = std::ranges::count_if(others, [&](const VehicleAhead& other) {
            const traffic::MotionState& state = other.vehicle->state;
            return state.lane == lane && std::abs(state.lane_position_m - own.lane_position_m) < side_room_m;
        });
        if (best && beside >= fewest) continue;
        best = number;
        fewest = beside;
    }
    return best;
}

}  // namespace clearway::policy::detail
