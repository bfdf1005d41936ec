#include "policy/rescue_lane.hpp"

#include <algorithm>
#include <vector>

#include "policy/detail/view.hpp"

namespace clearway::policy {
namespace {

using detail::LeaseWriter;
using detail::VehicleAhead;
using detail::View;

/// Nobody is slowed down below this, m/s: a share of its own speed again and again would end at 0.
constexpr double crawl_mps = 0.7;

/// Lanes of an edge that traffic uses: shoulders and sidewalks are left out.
std::vector<std::uint32_t> driven_lanes(const roads::Network& network, core::EdgeIndex edge) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t number = 0; number < network.edge(edge).lane_count; ++number) {
        if (network.lane(network.lane_of(edge, number)).allows_cars) numbers.push_back(number);
    }
    return numbers;
}

bool ends_at_signal(const roads::Network& network, core::EdgeIndex edge) {
    for (std::uint32_t number = 0; number < network.edge(edge).lane_count; ++number) {
        if (std::ranges::any_of(network.connections_from(network.lane_of(edge, number)),
                                [](const roads::Connection& way) { return way.signal.exists(); }))
            return true;
    }
    return false;
}

/// Whether a signal stands on the vehicle's route up to `reach_m` ahead or behind, or at the end of the
/// route. Ways across junctions count as nothing.
bool is_near_signal(const View& view, const traffic::BelievedVehicle& vehicle, double reach_m) {
    const roads::Network& network = view.network();
    const roads::Route route = view.route_of(vehicle.key);
    const roads::Lane& lane = network.lane(vehicle.state.lane);
    const bool is_inside = network.edge(lane.edge).internal;
    double passed_m = is_inside ? 0.0 : vehicle.state.lane_position_m;
    double ahead_m = is_inside ? 0.0 : lane.length_m - passed_m;
    const std::size_t own = vehicle.state.route_edge;
    for (std::size_t at = is_inside ? own + 1 : own; at < route.size(); ++at) {
        if (is_inside || at > own) ahead_m += network.edge(route[at]).length_m;
        if (ahead_m >= reach_m) break;
        if (ends_at_signal(network, route[at])) return true;
    }
    for (std::size_t behind = is_inside ? own + 1 : own; behind > 0 && passed_m < reach_m; --behind) {
        if (ends_at_signal(network, route[behind - 1])) return true;
        passed_m += network.edge(route[behind - 1]).length_m;
    }
    return false;
}

class Rescue {
  public:
    Rescue(const View& view, const RescueLaneConfig& config, const traffic::BelievedVehicle& emergency,
           std::uint32_t& place, LeaseWriter& write)
        : view_(view),
          config_(config),
          emergency_(emergency),
          place_(place),
          write_(write),
          audience_(view.belief(), emergency.key, config) {
        std::vector<VehicleAhead> behind = view.vehicles_behind(emergency, core::Metres(config.behind_m));
        std::ranges::reverse(behind);
        take(behind);
        take(view.vehicles_ahead(emergency, core::Metres(config.horizon_m)));
    }

    void open() {
        if (!is_needed()) return;
        if (!is_in_place()) {
            write_.add(emergency_.key, traffic::StandBack{},
                       "a rescue lane is for fast roads without signals", emergency_.key);
            return;
        }
        choose_place();
        for (const VehicleAhead& other : around_) {
            const auto from_left = lanes_from_left(*other.vehicle);
            if (!from_left || !audience_.has(*other.vehicle)) continue;
            const traffic::Side side = *from_left <= place_ ? traffic::Side::left : traffic::Side::right;
            write_.add(other.vehicle->key, traffic::PullAside{side}, "forms a rescue lane", emergency_.key);
        }
        if (config_.stagger_m > 0.0) move_apart();
    }

  private:
    void take(const std::vector<VehicleAhead>& others) {
        std::ranges::copy_if(others, std::back_inserter(around_), [&](const VehicleAhead& other) {
            return !view_.network().edge(*view_.edge_of(*other.vehicle)).internal;
        });
    }

    /// Whether there is slow traffic ahead. Who still drives fast there is asked, too: it would take the
    /// rescue lane to pass the others.
    bool is_needed() const {
        return std::ranges::any_of(around_, [&](const VehicleAhead& other) {
            return other.distance_m >= 0.0 && other.vehicle->state.speed_mps < config_.slow_mps;
        });
    }

    bool is_in_place() const {
        return view_.network().lane(emergency_.state.lane).speed_limit_mps >= config_.least_limit_mps &&
               !is_near_signal(view_, emergency_, config_.signal_m);
    }

    /// How many lanes are left of the vehicle's; nothing where there is only one lane.
    std::optional<std::uint32_t> lanes_from_left(const traffic::BelievedVehicle& vehicle) const {
        const std::vector<std::uint32_t> numbers = driven_lanes(view_.network(), *view_.edge_of(vehicle));
        const auto own = std::ranges::find(numbers, view_.lane_number(vehicle));
        if (numbers.size() < 2 || own == numbers.end()) return std::nullopt;
        return static_cast<std::uint32_t>(std::distance(own, numbers.end()) - 1);
    }

    /// Vehicles that are not asked in the two lanes beside a place.
    double strangers_beside(std::uint32_t place) const {
        return static_cast<double>(std::ranges::count_if(around_, [&](const VehicleAhead& other) {
            const auto from_left = lanes_from_left(*other.vehicle);
            return other.distance_m >= 0.0 && from_left && !audience_.has(*other.vehicle) &&
                   (*from_left == place || *from_left == place + 1);
        }));
    }

    void choose_place() {
        const core::EdgeIndex edge = *view_.edge_of(emergency_);
        if (view_.network().edge(edge).internal) return;
        const std::size_t lanes = driven_lanes(view_.network(), edge).size();
        if (lanes < 2) return;
        place_ = std::min<std::uint32_t>(place_, static_cast<std::uint32_t>(lanes - 2));
        double fewest = strangers_beside(place_) - config_.switch_worth;
        for (std::uint32_t place = 0; place + 2 <= lanes; ++place) {
            const double strangers = strangers_beside(place);
            if (strangers > fewest) continue;
            fewest = strangers;
            place_ = place;
        }
    }

    /// How far the vehicle reaches into the road from the outer edge of its lane, m: one that is asked keeps
    /// to that edge, another drives in the middle.
    double reach_m(const VehicleAhead& other) const {
        const double width_m = view_.info_of(*other.vehicle).width_m;
        const double lane_m = view_.network().lane(other.vehicle->state.lane).width_m;
        return audience_.has(*other.vehicle) ? width_m : (lane_m + width_m) / 2.0;
    }

    bool leave_room(const VehicleAhead& left, const VehicleAhead& right) const {
        const double road_m = view_.network().lane(left.vehicle->state.lane).width_m +
                              view_.network().lane(right.vehicle->state.lane).width_m;
        return road_m - reach_m(left) - reach_m(right) >= view_.info_of(emergency_).width_m + config_.room_m;
    }

    /// Whether less than `apart_m` lies between the two along the road; while the emergency vehicle is beside
    /// the rear one or just ahead of it, its own length more, so that it can steer.
    bool are_abreast(const VehicleAhead& rear, const VehicleAhead& front) const {
        const double between_m = front.distance_m - view_.info_of(*front.vehicle).length_m - rear.distance_m;
        const double own_m = rear.distance_m < 0.0 ? view_.info_of(emergency_).length_m : 0.0;
        return between_m < config_.apart_m + own_m;
    }

    /// The nearest two that block the rescue lane: the rear one slows down, or the front one, or who drives
    /// ahead of them.
    void move_apart() {
        for (const VehicleAhead& left : around_) {
            if (left.distance_m > config_.stagger_m) return;
            if (lanes_from_left(*left.vehicle) != place_) continue;
            for (const VehicleAhead& right : around_) {
                if (lanes_from_left(*right.vehicle) != place_ + 1 || leave_room(left, right)) continue;
                const bool left_is_rear = left.distance_m < right.distance_m;
                const VehicleAhead& rear = left_is_rear ? left : right;
                const VehicleAhead& front = left_is_rear ? right : left;
                if (is_passed(front) || !are_abreast(rear, front)) continue;
                if (slow_down(rear) || slow_down(front) || slow_leader(rear) || slow_leader(front)) return;
            }
        }
    }

    /// Whether the front of the emergency vehicle is beside the vehicle or ahead of it.
    bool is_passed(const VehicleAhead& other) const {
        return other.distance_m < view_.info_of(*other.vehicle).length_m;
    }

    bool slow_down(const VehicleAhead& other) {
        if (!audience_.has(*other.vehicle)) return false;
        const double speed_mps = std::max(config_.stagger_share * other.vehicle->state.speed_mps, crawl_mps);
        write_.add(other.vehicle->key, traffic::DriveAt{core::MetresPerSecond(speed_mps)},
                   "moves apart from one abreast that blocks the rescue lane", emergency_.key);
        return true;
    }

    /// Asks the vehicle next ahead on the lane of `follower` to slow down, if it can be asked.
    bool slow_leader(const VehicleAhead& follower) {
        const auto leader = std::ranges::find_if(around_, [&](const VehicleAhead& other) {
            return other.distance_m > follower.distance_m &&
                   other.vehicle->state.lane == follower.vehicle->state.lane;
        });
        return leader != around_.end() && slow_down(*leader);
    }

    const View& view_;
    const RescueLaneConfig& config_;
    const traffic::BelievedVehicle& emergency_;
    std::uint32_t& place_;
    LeaseWriter& write_;
    Audience audience_;
    std::vector<VehicleAhead> around_;  ///< From the rear.
};

}  // namespace

void RescueLane::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const View view(context_.network, belief);
    LeaseWriter write("rescue_lane", context_.period, belief.time, leases, config_.lease_s,
                      detail::aside_priority);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles())
        Rescue(view, config_, emergency, place_[emergency.key], write).open();
}

}  // namespace clearway::policy
