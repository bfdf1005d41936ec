#include "policy/give_way.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "policy/detail/approach.hpp"
#include "roads/route.hpp"

namespace clearway::policy {
namespace {

/// Maps cut streets into pieces. Who stops at the end of one that ends so near to the junction leaves it
/// free, m.
constexpr double last_pieces_m = 25.0;

/// Edges by which a way leads into a junction and out of it.
using Turn = std::pair<core::EdgeIndex, core::EdgeIndex>;

/// A junction without a signal at which an emergency vehicle must yield.
struct Junction {
    core::EdgeIndex edge_in;
    double distance_m = 0.0;
    roads::Point place;
    std::set<Turn> prior;  ///< Whom it must yield to and who may be asked.
};

/// Whether anybody may be asked to stop on a lane.
bool may_stop_on(const roads::Network& network, const roads::Lane& lane, double fastest_road_mps) {
    return !network.edge(lane.edge).roundabout && lane.speed_limit_mps <= fastest_road_mps;
}

class JunctionsAhead {
  public:
    JunctionsAhead(const roads::Network& network, const GiveWayConfig& config)
        : network_(network), config_(config) {}

    std::vector<Junction> of(const detail::View& view, const traffic::BelievedVehicle& emergency) {
        std::vector<Junction> found;
        const roads::Route route = view.route_of(emergency.key);
        roads::lanes_ahead(network_, route, emergency.state, core::Metres(config_.horizon_m), steps_);
        for (const roads::RouteStep& step : steps_) {
            const bool is_first = &step == &steps_.front();
            const bool is_inside = network_.edge(network_.lane(step.lane).edge).internal;
            if ((is_inside && !is_first) || step.route_edge + 1 >= route.size()) continue;
            Junction junction{route[step.route_edge], is_inside ? 0.0 : std::max(0.0F, step.end_m),
                              network_.lane(step.lane).shape.back(),
                              prior_turns(route[step.route_edge], route[step.route_edge + 1])};
            if (!junction.prior.empty()) found.push_back(std::move(junction));
        }
        return found;
    }

  private:
    std::set<Turn> prior_turns(core::EdgeIndex from, core::EdgeIndex to) const {
        std::set<Turn> turns;
        const roads::Edge& edge = network_.edge(from);
        for (std::uint32_t row = edge.first_lane; row < edge.first_lane + edge.lane_count; ++row)
            for (const roads::Connection& way : network_.connections_from(core::LaneIndex{row})) {
                if (network_.lane(way.to).edge != to || !way.allows_emergency) continue;
                for (const std::uint32_t prior : network_.prior_to(way)) {
                    const roads::Connection& other = network_.connection(prior);
                    const roads::Lane& lane = network_.lane(other.from);
                    if (may_stop_on(network_, lane, config_.fastest_road_mps) && lane.edge != from)
                        turns.emplace(lane.edge, network_.lane(other.to).edge);
                }
            }
        return turns;
    }

    const roads::Network& network_;
    const GiveWayConfig& config_;
    std::vector<roads::RouteStep> steps_;
};

/// Whether a vehicle comes to one of the turns within `near_m`, and would stop near the junction at the end
/// of its lane.
bool takes_one_of(const detail::View& view, const traffic::BelievedVehicle& vehicle,
                  const std::set<Turn>& turns, double near_m, std::vector<roads::RouteStep>& steps) {
    const roads::Network& network = view.network();
    const roads::Route route = view.route_of(vehicle.key);
    roads::lanes_ahead(network, route, vehicle.state, core::Metres(near_m), steps);
    for (const roads::RouteStep& step : steps) {
        if (step.end_m > near_m || step.end_m - steps.front().end_m > last_pieces_m) return false;
        const core::EdgeIndex edge = network.lane(step.lane).edge;
        if (!network.edge(edge).internal && step.route_edge + 1 < route.size() &&
            turns.contains({edge, route[step.route_edge + 1]}))
            return true;
    }
    return false;
}

/// Whether a vehicle may be asked to stop at the end of its lane.
bool may_stop(const detail::View& view, const traffic::BelievedVehicle& vehicle, double fastest_road_mps) {
    if (!view.is_on_route(vehicle)) return false;
    const roads::Lane& lane = view.network().lane(vehicle.state.lane);
    return !view.network().edge(lane.edge).internal && may_stop_on(view.network(), lane, fastest_road_mps);
}

/// Vehicles that drive ahead of an emergency vehicle: none of them may be held.
std::set<core::VehicleKey> ahead_of_one(const detail::View& view,
                                        const std::vector<traffic::BelievedVehicle>& emergencies,
                                        double horizon_m) {
    std::set<core::VehicleKey> ahead;
    for (const traffic::BelievedVehicle& emergency : emergencies)
        for (const detail::VehicleAhead& other : view.vehicles_ahead(emergency, core::Metres(horizon_m)))
            ahead.insert(other.vehicle->key);
    return ahead;
}

bool is_near(const traffic::MotionState& state, const roads::Point& place, double near_m) {
    return std::hypot(state.x_m - place.x_m, state.y_m - place.y_m) < near_m;
}

}  // namespace

bool GiveWay::is_early(const detail::View& view, const traffic::BelievedVehicle& emergency,
                       double distance_m) const {
    const double speed_mps = std::max<double>(emergency.state.speed_mps, config_.slowest_mps);
    const double arrival_s = distance_m / speed_mps;
    if (arrival_s > config_.longest_lead_s) return true;
    const auto halted =
        static_cast<double>(detail::queue_ahead(view, emergency, {0.0, distance_m}, config_.halted_mps));
    return arrival_s > config_.lead_s + config_.lead_per_halted_s * halted;
}

void GiveWay::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("give_way", context_.period, belief.time, leases, config_.lease_s);
    JunctionsAhead junctions(context_.network, config_);
    const std::vector<traffic::BelievedVehicle> emergencies = view.emergency_vehicles();
    std::optional<std::set<core::VehicleKey>> not_held;
    std::map<Passage, double> kept_free_s;
    std::map<core::VehicleKey, double> held_s;
    std::vector<roads::RouteStep> steps;
    const auto lasted_s = [&](auto& before, auto& now, const auto& key) {
        const auto known = before.find(key);
        return belief.time.value - (now[key] = known == before.end() ? belief.time.value : known->second);
    };
    for (const traffic::BelievedVehicle& emergency : emergencies) {
        const Audience audience(belief, emergency.key, config_);
        for (const Junction& junction : junctions.of(view, emergency)) {
            const Passage passage{emergency.key, junction.edge_in};
            if (!kept_free_s_.contains(passage) && is_early(view, emergency, junction.distance_m)) continue;
            if (lasted_s(kept_free_s_, kept_free_s, passage) > config_.longest_s) continue;
            if (!not_held) not_held = ahead_of_one(view, emergencies, config_.horizon_m);
            for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
                // A junction may be so wide that the end of its other arms is this much farther away.
                constexpr double width_m = 50.0;
                if (!audience.has(vehicle) || not_held->contains(vehicle.key) ||
                    !is_near(vehicle.state, junction.place, config_.near_m + width_m) ||
                    !may_stop(view, vehicle, config_.fastest_road_mps) ||
                    !takes_one_of(view, vehicle, junction.prior, config_.near_m, steps))
                    continue;
                if (lasted_s(held_s_, held_s, vehicle.key) > config_.longest_s) continue;
                write.add(vehicle.key, traffic::StopAtLine{}, "gives way to an emergency vehicle",
                          emergency.key);
            }
        }
    }
    kept_free_s_ = std::move(kept_free_s);
    held_s_ = std::move(held_s);
}

}  // namespace clearway::policy
