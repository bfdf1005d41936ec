#include "drivers/privilege.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/detail/gap_across.hpp"
#include "roads/route.hpp"
#include "traffic/passing_red.hpp"

namespace clearway::drivers {
namespace {

using detail::Across;

/// Vehicles that are this much slower than the emergency vehicle may drive are worth passing.
constexpr double worth_passing = 0.8;
/// Less room than this beside it, m, and the emergency vehicle drives at `between_mps`.
constexpr double little_room_m = 1.0;
/// Vehicles whose heading differs by more than this are on another road, rad.
constexpr double same_heading_rad = 0.5;
constexpr double speed_resolution_mps = 0.05;

/// A place as seen from an emergency vehicle: how far ahead, and how far to the left, m.
struct Seen {
    double ahead_m = 0.0;
    double left_m = 0.0;
};

class Eyes {
  public:
    Eyes(const truth::Snapshot& snapshot, core::VehicleIndex row, double heading_rad)
        : x_m_(snapshot.x_m[row]),
          y_m_(snapshot.y_m[row]),
          cosine_(std::cos(heading_rad)),
          sine_(std::sin(heading_rad)) {}

    Seen see(double x_m, double y_m) const {
        const double east_m = x_m - x_m_;
        const double north_m = y_m - y_m_;
        return {east_m * cosine_ + north_m * sine_, north_m * cosine_ - east_m * sine_};
    }

  private:
    double x_m_, y_m_, cosine_, sine_;
};

/// The lanes beside `lane` that are open to emergency vehicles, across the road as seen by `eyes`.
Across road_across(const roads::Network& network, core::LaneIndex lane, double position_m, const Eyes& eyes) {
    const roads::Lane& own = network.lane(lane);
    const roads::Edge& edge = network.edge(own.edge);
    const roads::Point centre = network.point_at(lane, core::Metres(position_m));
    Across road;
    road.right_m = eyes.see(centre.x_m, centre.y_m).left_m - own.width_m / 2.0;
    road.left_m = road.right_m + own.width_m;
    const auto beside = [&](std::uint32_t number) -> const roads::Lane& {
        return network.lane(network.lane_of(own.edge, number));
    };
    for (std::uint32_t number = own.number; number-- > 0 && beside(number).allows_emergency;)
        road.right_m -= beside(number).width_m;
    for (std::uint32_t number = own.number + 1; number < edge.lane_count && beside(number).allows_emergency;
         ++number)
        road.left_m += beside(number).width_m;
    return road;
}

}  // namespace

Privilege::Privilege(const roads::Network& network, const PrivilegeConfig& config,
                     traffic::LateralModel lateral)
    : network_(network), config_(config), lateral_(lateral) {}

void Privilege::step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                     std::vector<traffic::Command>& commands) {
    if (config_.none()) return;
    const bool steers = config_.between_lanes != 0 && lateral_ == traffic::LateralModel::sublane;
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != traffic::VehicleClass::emergency) continue;
        if (!snapshot.lane[row].exists()) continue;
        Use wanted;
        if (config_.pass_red != 0) judge_red(snapshot, roster, row, wanted);
        const double shift_m = steers ? judge_gap(snapshot, roster, row, wanted) : 0.0;
        const core::VehicleKey key = snapshot.key[row];
        apply(key, wanted, uses_[key], commands);
        if (wanted.is_free) commands.push_back(traffic::SteerSideways{key, core::Metres(shift_m)});
    }
    std::erase_if(uses_, [&](const auto& entry) { return !snapshot.row_of(entry.first); });
}

/// The first signal ahead that does not show green to the vehicle lowers its speed towards the stop line.
void Privilege::judge_red(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                          core::VehicleIndex row, Use& use) const {
    const traffic::VehicleInfo* const info = roster.find(snapshot.key[row]);
    if (info == nullptr || !info->route.exists()) return;
    const roads::Route route = roster.route(info->route);
    const traffic::MotionState state = snapshot.motion(row);
    if (state.route_edge >= route.size()) return;
    for (const roads::StopLine& line :
         roads::signals_ahead(network_, route, state, core::Metres(config_.red_near_m))) {
        const std::string& shown = snapshot.signals.state[line.signal.value];
        if (!traffic::holds_back(shown, line.links)) continue;
        use.passes_red = true;
        const double speed_mps =
            traffic::speed_before_line(config_.red_mps, config_.red_braking_mps2, line.distance.value);
        if (speed_mps < info->maximum_speed_mps) use.speed_mps = speed_mps;
        return;
    }
}

/// Looks for a way through the slow vehicles ahead and beside: first through all of them within `look_m`,
/// else through the nearest ones, else the vehicle stays where it is across the road.
double Privilege::judge_gap(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                            core::VehicleIndex row, Use& use) const {
    const traffic::VehicleInfo* const info = roster.find(snapshot.key[row]);
    const roads::Lane& lane = network_.lane(snapshot.lane[row]);
    if (info == nullptr || network_.edge(lane.edge).internal) return 0.0;
    const double position_m = snapshot.lane_position_m[row];
    const double heading_rad = network_.heading_at(snapshot.lane[row], core::Metres(position_m));
    const Eyes eyes(snapshot, row, heading_rad);
    const double slow_mps = worth_passing * std::min<double>(lane.speed_limit_mps, info->maximum_speed_mps);
    struct Body {
        double ahead_m;
        Across across;
    };
    std::vector<Body> bodies;
    for (core::VehicleIndex other = 0; other < snapshot.size(); ++other) {
        const traffic::VehicleInfo* const its = roster.find(snapshot.key[other]);
        if (other == row || its == nullptr || snapshot.speed_mps[other] > slow_mps) continue;
        if (std::abs(std::remainder(snapshot.heading_rad[other] - heading_rad, 2.0 * std::numbers::pi)) >
            same_heading_rad)
            continue;
        const Seen front = eyes.see(snapshot.x_m[other], snapshot.y_m[other]);
        const double rear_m = front.ahead_m - its->length_m;
        if (front.ahead_m < -info->length_m || rear_m > config_.look_m) continue;
        bodies.push_back({rear_m, {front.left_m - its->width_m / 2.0, front.left_m + its->width_m / 2.0}});
    }
    if (bodies.empty()) return 0.0;
    use.is_free = true;
    const Across road = road_across(network_, snapshot.lane[row], position_m, eyes);
    const double needed_m = info->width_m + config_.margin_m;
    std::ranges::sort(bodies, {}, &Body::ahead_m);
    std::vector<Across> occupied;
    double shift_m = 0.0;
    double room_m = road.width_m();
    for (const Body& body : bodies) {
        occupied.push_back(body.across);
        const auto free = detail::nearest_free(road, occupied, needed_m);
        if (!free) break;
        shift_m = detail::shift_into(*free, needed_m);
        room_m = free->width_m();
    }
    const bool is_tight = room_m < info->width_m + 2.0 * little_room_m;
    if (is_tight && (!use.speed_mps || *use.speed_mps > config_.between_mps))
        use.speed_mps = config_.between_mps;
    return shift_m;
}

void Privilege::apply(core::VehicleKey key, const Use& wanted, Use& applied,
                      std::vector<traffic::Command>& commands) {
    if (wanted.passes_red != applied.passes_red)
        commands.push_back(traffic::SetJunctionPrivilege{key, wanted.passes_red
                                                                  ? traffic::JunctionPrivilege::pass_red
                                                                  : traffic::JunctionPrivilege::none});
    if (wanted.is_free != applied.is_free) {
        commands.push_back(traffic::SetLaneChangeFreedom{
            key, wanted.is_free ? traffic::LaneChangeFreedom::none : traffic::LaneChangeFreedom::normal});
        commands.push_back(traffic::SetLateralAlignment{
            key, wanted.is_free ? traffic::LateralAlignment::free : traffic::LateralAlignment::usual});
    }
    if (wanted.speed_mps) {
        const bool same =
            applied.speed_mps && std::abs(*wanted.speed_mps - *applied.speed_mps) < speed_resolution_mps;
        applied.speed_mps = same ? applied.speed_mps : wanted.speed_mps;
        if (!same) commands.push_back(traffic::SetSpeed{key, core::MetresPerSecond(*wanted.speed_mps)});
    } else if (applied.speed_mps) {
        commands.push_back(traffic::ReleaseSpeed{key});
        applied.speed_mps.reset();
    }
    applied.passes_red = wanted.passes_red;
    applied.is_free = wanted.is_free;
}

void Privilege::restore_all(std::vector<traffic::Command>& commands) {
    for (auto& [key, use] : uses_)
        apply(key, Use{}, use, commands);
    uses_.clear();
}

}  // namespace clearway::drivers
