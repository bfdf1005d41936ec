#include "prediction/twin_traffic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "prediction/detail/nearly_sorted.hpp"
#include "traffic/signal.hpp"

namespace clearway::prediction {

using detail::VehicleOnLane;

namespace {

constexpr float least_gap_m = 0.1F;
constexpr double same_time_s = 1e-3;
/// A path is laid this far, and anew when less than a twin's view is left of it.
constexpr float path_m = 400.0F;
/// How far a twin looks: a vehicle ahead that stands, seen from further off, slows nobody by the IDM.
constexpr float least_view_m = 60.0F;
constexpr float view_s = 6.0F;
/// SUMO's vehicles stop a metre before the line.
constexpr float line_gap_m = 1.0F;
/// What tyres hold on a dry road (SUMO's emergencyDecel of cars).
constexpr float hardest_braking_mps2 = 9.0F;
/// A limit below walking speed is a lane that is closed or badly mapped.
constexpr float least_limit_mps = 1.0F;
/// Speeds shown on slower lanes say little of what a driver wants.
constexpr float least_shown_mps = 5.0F;

float square(float value) {
    return value * value;
}

/// Whether a state is where its route says, so that the route can be walked from there.
bool lies_on_route(const roads::Network& network, const traffic::Observation& observation,
                   const traffic::VehicleInfo* info, const traffic::MotionState& state) {
    if (info == nullptr || !info->route.exists() || !state.lane.exists()) return false;
    const auto& route = observation.roster->route(info->route);
    if (state.route_edge >= route.size()) return false;
    const core::EdgeIndex edge = network.lane(state.lane).edge;
    return network.edge(edge).internal || edge == route[state.route_edge];
}

}  // namespace

float IdmDriver::free(float speed_mps, float desired_mps) const {
    return acceleration_mps2 * (1.0F - std::pow(speed_mps / desired_mps, exponent));
}

float IdmDriver::interaction(float speed_mps, float gap_m, float closing_mps) const {
    const float approach_m =
        speed_mps * (headway_s + closing_mps / (2.0F * std::sqrt(acceleration_mps2 * deceleration_mps2)));
    const float desired_m = min_gap_m + std::max(0.0F, approach_m);
    return acceleration_mps2 * square(desired_m / std::max(least_gap_m, gap_m));
}

TwinTraffic::TwinTraffic(const roads::Network& network, const CarFollowingConfig& config)
    : network_(network), config_(config) {}

void TwinTraffic::follow(const traffic::Observation& observation, const Tracks& tracks) {
    match_rows(tracks);
    lagging_.clear();
    double from_s = tracks.time_s;
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        take_report(observation, tracks, row);
        Twin& twin = twins_[twin_of_row_[row]];
        twin.row = row;
        if (!twin.on_route) continue;
        const bool is_now = twin.time_s > tracks.time_s - same_time_s;
        if (!is_now || tracks.known[row] == 0) lay_path(observation, twin);
        if (is_now) continue;
        lagging_.push_back(twin_of_row_[row]);
        from_s = std::min(from_s, twin.time_s);
    }
    const auto steps = static_cast<int>(std::ceil((tracks.time_s - from_s) / config_.step_s - same_time_s));
    for (int step = 0; step < steps; ++step) {
        const double left_s = config_.step_s * (steps - step - 1);
        drive(observation, std::max(from_s, tracks.time_s - left_s - config_.step_s), tracks.time_s - left_s);
    }
    if (!tracks.all_known) list_places(tracks.time_s);
}

/// Both lists are ordered by key. Twins of vehicles that are gone are given to new ones.
void TwinTraffic::match_rows(const Tracks& tracks) {
    std::swap(twin_of_row_, old_twin_of_row_);
    twin_of_row_.resize(tracks.size());
    auto old = old_twin_of_row_.begin();
    const std::size_t unused_before = unused_.size();
    constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        for (; old != old_twin_of_row_.end() && twins_[*old].key < tracks.key[row]; ++old)
            unused_.push_back(*old);
        const bool known = old != old_twin_of_row_.end() && twins_[*old].key == tracks.key[row];
        twin_of_row_[row] = known ? *old++ : nobody;
    }
    unused_.insert(unused_.end(), old, old_twin_of_row_.end());
    if (unused_.size() > unused_before) {
        for (std::size_t at = unused_before; at < unused_.size(); ++at)
            twins_[unused_[at]].key = {};
        std::erase_if(in_order_,
                      [&](std::uint32_t index) { return twins_[index].key == core::VehicleKey{}; });
    }
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        if (twin_of_row_[row] != nobody) continue;
        if (unused_.empty()) {
            unused_.push_back(static_cast<std::uint32_t>(twins_.size()));
            twins_.emplace_back();
        }
        twin_of_row_[row] = unused_.back();
        unused_.pop_back();
        in_order_.push_back(twin_of_row_[row]);
        Twin& twin = twins_[twin_of_row_[row]];
        twin.key = tracks.key[row];
        twin.report_s = std::numeric_limits<double>::lowest();
        twin.time_s = twin.report_s;
    }
}

void TwinTraffic::take_report(const traffic::Observation& observation, const Tracks& tracks,
                              std::uint32_t row) {
    Twin& twin = twins_[twin_of_row_[row]];
    const double report_s = tracks.time_s - tracks.age_s[row];
    const traffic::VehicleInfo* const info = tracks.info[row];
    const core::RouteIndex route = info == nullptr ? core::RouteIndex::none() : info->route;
    const bool is_old =
        std::abs(report_s - twin.report_s) < same_time_s && twin.time_s < tracks.time_s + same_time_s;
    if (is_old && route == twin.route) return;
    const traffic::MotionState& seen = tracks.last[row];
    const bool starts = report_s < twin.report_s || twin.report_s == std::numeric_limits<double>::lowest();
    constexpr FilterNoise noise;
    const float sigma_m = tracks.sensor_sigma_m[row];
    if (starts || sigma_m == 0.0F) {
        start(seen, sigma_m, noise, twin.filter);
    } else if (!is_old) {
        prediction::follow(seen, sigma_m, static_cast<float>(report_s - twin.report_s), noise, twin.filter);
    }
    register_driver(info, twin);
    learn_speed(seen, starts, twin);
    twin.route = route;
    twin.seen = seen;
    twin.report_s = report_s;
    twin.time_s = report_s;
    twin.on_route = lies_on_route(network_, observation, info, seen);
    twin.at_end = false;
    twin.path.clear();
    twin.before_path_m = 0.0F;
    twin.travelled_m = 0.0F;
    twin.speed_mps = seen.speed_mps;
    twin.lane = seen.lane;
    twin.lane_position_m = seen.lane_position_m;
    twin.route_edge = seen.route_edge;
}

void TwinTraffic::register_driver(const traffic::VehicleInfo* info, Twin& twin) const {
    static const traffic::VehicleInfo typical;
    const traffic::VehicleInfo& vehicle = info == nullptr ? typical : *info;
    const auto least = [](double value) { return std::max(0.1F, static_cast<float>(value)); };
    twin.driver = {least(vehicle.acceleration_mps2), least(vehicle.deceleration_mps2),
                   static_cast<float>(config_.headway_s), static_cast<float>(config_.min_gap_m),
                   static_cast<float>(config_.exponent)};
    twin.length_m = vehicle.length_m;
    twin.maximum_speed_mps = least(vehicle.maximum_speed_mps);
    if (config_.know_speed_factor != 0)
        twin.speed_factor = static_cast<float>(config_.speed_factor) * vehicle.speed_factor;
}

/// A driver wants at least the speed that it shows; a lower one may be owed to the traffic.
void TwinTraffic::learn_speed(const traffic::MotionState& seen, bool is_new, Twin& twin) const {
    if (config_.know_speed_factor != 0) return;
    if (is_new) twin.speed_factor = static_cast<float>(config_.speed_factor);
    if (config_.estimate == 0 || !seen.lane.exists() || seen.speed_mps < least_shown_mps) return;
    constexpr float up = 0.5F;
    const float shown = seen.speed_mps / std::max(least_limit_mps, network_.lane(seen.lane).speed_limit_mps);
    const float steady = std::abs(seen.speed_mps - twin.seen.speed_mps) < 0.3F ? 0.1F : 0.0F;
    twin.speed_factor += (shown > twin.speed_factor ? up : steady * (shown > 0.8F ? 1.0F : 0.0F)) *
                         (std::min(shown, 1.5F) - twin.speed_factor);
}

/// From where the twin is, if what is left of its path is shorter than its view.
void TwinTraffic::lay_path(const traffic::Observation& observation, Twin& twin) {
    const float view_m = least_view_m + view_s * twin.speed_mps;
    if (!twin.path.empty() && (twin.ends || twin.path.back().road.end_m - twin.travelled_m > view_m)) return;
    traffic::MotionState place;
    place.lane = twin.lane;
    place.lane_position_m = twin.lane_position_m;
    place.route_edge = twin.route_edge;
    const auto& route = observation.roster->route(twin.route);
    twin.ends = !roads::lanes_ahead(network_, route, place, core::Metres(path_m), walked_);
    twin.path.clear();
    for (std::size_t at = 0; at < walked_.size(); ++at) {
        Step& step = twin.path.emplace_back();
        step.road = walked_[at];
        step.limit_mps = std::max(least_limit_mps, network_.lane(step.road.lane).speed_limit_mps);
        step.exit_lane = at + 1 < walked_.size() ? exit_lane(step.road, walked_[at + 1]) : step.road.lane;
    }
    twin.at = 0;
    twin.before_path_m += twin.travelled_m;
    twin.travelled_m = 0.0F;
}

/// The lane of a step's edge, nearest to the step's own, whose connection the next step takes.
core::LaneIndex TwinTraffic::exit_lane(const roads::RouteStep& step, const roads::RouteStep& next) const {
    const roads::Edge& edge = network_.edge(network_.lane(step.lane).edge);
    const auto leads_on = [&](core::LaneIndex lane) {
        return std::ranges::any_of(network_.connections_from(lane), [&](const roads::Connection& way) {
            return (way.via.exists() ? way.via : way.to) == next.lane;
        });
    };
    if (leads_on(step.lane)) return step.lane;
    const int own = static_cast<int>(network_.lane(step.lane).number);
    for (int away = 1; away < static_cast<int>(edge.lane_count); ++away) {
        for (const int number : {own - away, own + away}) {
            if (number < 0 || number >= static_cast<int>(edge.lane_count)) continue;
            const core::LaneIndex lane{edge.first_lane + static_cast<std::uint32_t>(number)};
            if (leads_on(lane)) return lane;
        }
    }
    return step.lane;
}

/// Where everybody is at `time_s`; those that reported later are taken back at their present speed.
void TwinTraffic::list_places(double time_s) {
    places_.clear();
    left_out_.clear();
    for (const std::uint32_t index : in_order_) {
        const Twin& twin = twins_[index];
        // One without a route is gone from where it was last seen.
        const bool gone = !twin.on_route && twin.time_s < time_s - same_time_s;
        if (!twin.lane.exists() || twin.at_end || gone) {
            left_out_.push_back(index);
            continue;
        }
        const float back_m = twin.speed_mps * static_cast<float>(twin.time_s - time_s);
        places_.push_back({twin.lane, twin.lane_position_m - std::max(0.0F, back_m), twin.key, index});
    }
    detail::sort_nearly_sorted(places_, moved_);
    std::ranges::transform(places_, in_order_.begin(), &VehicleOnLane::index);
    std::ranges::copy(left_out_, in_order_.begin() + static_cast<std::ptrdiff_t>(places_.size()));
}

void TwinTraffic::drive(const traffic::Observation& observation, double from_s, double to_s) {
    list_places(from_s);
    const auto still_before = [&](const Twin& twin) {
        return !twin.at_end && twin.time_s < to_s - same_time_s;
    };
    for (const std::uint32_t index : lagging_) {
        Twin& twin = twins_[index];
        if (!still_before(twin)) continue;
        lay_path(observation, twin);
        change_lane(twin);
        const auto elapsed_s = static_cast<float>(to_s - twin.time_s);
        twin.next_speed_mps = std::max(0.0F, twin.speed_mps + elapsed_s * acceleration(observation, twin));
    }
    for (const std::uint32_t index : lagging_) {
        Twin& twin = twins_[index];
        if (still_before(twin)) move(to_s, twin);
    }
}

float TwinTraffic::desired_speed_mps(const Twin& twin, float limit_mps) const {
    return std::min(twin.maximum_speed_mps, std::max(least_limit_mps, limit_mps * twin.speed_factor));
}

float TwinTraffic::acceleration(const traffic::Observation& observation, const Twin& twin) const {
    Ahead ahead;
    look_ahead(observation, twin, ahead);
    const float free_mps2 =
        twin.driver.free(twin.speed_mps, desired_speed_mps(twin, twin.path[twin.at].limit_mps));
    return std::max(-hardest_braking_mps2, std::min(free_mps2 - ahead.interaction_mps2, ahead.limit_mps2));
}

void TwinTraffic::look_ahead(const traffic::Observation& observation, const Twin& twin, Ahead& ahead) const {
    const float horizon_m = twin.travelled_m + least_view_m + view_s * twin.speed_mps;
    bool vehicle = config_.follow_leaders == 0;
    bool line = config_.obey_signals == 0;
    for (std::size_t at = twin.at; at < twin.path.size(); ++at) {
        const Step& step = twin.path[at];
        if (step.road.start_m > horizon_m) return;
        const bool here = at == twin.at;
        if (!here) {
            const float limit_mps = desired_speed_mps(twin, step.limit_mps);
            const float way_m = std::max(least_gap_m, step.road.start_m - twin.travelled_m);
            const float braking_mps2 = (square(twin.speed_mps) - square(limit_mps)) / (2.0F * way_m);
            if (braking_mps2 > twin.driver.deceleration_mps2)
                ahead.limit_mps2 = std::min(ahead.limit_mps2, -braking_mps2);
        }
        if (!vehicle) {
            const Neighbour leader = next_on(twin, at);
            vehicle = leader.exists;
            if (vehicle)
                ahead.interaction_mps2 = std::max(
                    ahead.interaction_mps2,
                    twin.driver.interaction(twin.speed_mps, leader.gap_m, twin.speed_mps - leader.speed_mps));
        }
        const bool waits = here && twin.lane != step.exit_lane;
        const bool stops = !line && heed_signal(observation, twin, step.road, ahead);
        if (waits && !stops) {
            const float gap_m = step.road.end_m - twin.travelled_m + twin.driver.min_gap_m;
            ahead.interaction_mps2 = std::max(ahead.interaction_mps2,
                                              twin.driver.interaction(twin.speed_mps, gap_m, twin.speed_mps));
        }
        if (waits || stops) return;
    }
}

/// The first vehicle before the twin on a step of its path.
TwinTraffic::Neighbour TwinTraffic::next_on(const Twin& twin, std::size_t step) const {
    const bool here = step == twin.at;
    const core::LaneIndex lane = here ? twin.lane : twin.path[step].exit_lane;
    const VehicleOnLane after = here ? VehicleOnLane{lane, twin.lane_position_m, twin.key, 0}
                                     : VehicleOnLane{lane, std::numeric_limits<float>::lowest(), {}, 0};
    auto next = std::ranges::upper_bound(places_, after);
    while (next != places_.end() && next->key == twin.key)
        ++next;
    if (next == places_.end() || next->lane != lane) return {};
    const Twin& leader = twins_[next->index];
    const float gap_m = twin.path[step].road.start_m + next->position_m - leader.length_m - twin.travelled_m;
    return {true, leader.row, gap_m, leader.speed_mps};
}

/// What the signal at the end of a step shows; null where there is none.
const char* TwinTraffic::letter_of(const traffic::Observation& observation, const roads::RouteStep& step) {
    if (!step.signal.exists() || step.signal.value >= observation.signals.state.size()) return nullptr;
    const std::string& letters = observation.signals.state[step.signal.value];
    return step.signal_link < letters.size() ? &letters[step.signal_link] : nullptr;
}

/// Whether the twin stops at the end of a step.
bool TwinTraffic::heed_signal(const traffic::Observation& observation, const Twin& twin,
                              const roads::RouteStep& step, Ahead& ahead) const {
    const char* const shown = letter_of(observation, step);
    if (shown == nullptr || traffic::is_green(*shown)) return false;
    const char letter = *shown;
    const float way_m = step.end_m - twin.travelled_m;
    const bool yellow = letter == 'y' || letter == 'Y';
    const float most_mps2 = yellow ? twin.driver.deceleration_mps2 : hardest_braking_mps2;
    if (square(twin.speed_mps) > 2.0F * most_mps2 * std::max(0.0F, way_m)) return false;
    const float gap_m = way_m - line_gap_m + twin.driver.min_gap_m;
    ahead.interaction_mps2 =
        std::max(ahead.interaction_mps2, twin.driver.interaction(twin.speed_mps, gap_m, twin.speed_mps));
    return true;
}

void TwinTraffic::change_lane(Twin& twin) const {
    const core::LaneIndex wanted = twin.path[twin.at].exit_lane;
    if (twin.lane == wanted || network_.lane(twin.lane).edge != network_.lane(wanted).edge) return;
    if (has_room(twin, wanted)) twin.lane = wanted;
}

bool TwinTraffic::has_room(const Twin& twin, core::LaneIndex lane) const {
    const VehicleOnLane place{lane, twin.lane_position_m, twin.key, 0};
    const auto next = std::ranges::upper_bound(places_, place);
    if (next != places_.end() && next->lane == lane && next->key != twin.key &&
        next->position_m - twins_[next->index].length_m < twin.lane_position_m + twin.driver.min_gap_m)
        return false;
    if (next == places_.begin()) return true;
    const VehicleOnLane& behind = *(next - 1);
    return behind.lane != lane || behind.key == twin.key ||
           behind.position_m + twin.driver.min_gap_m < twin.lane_position_m - twin.length_m;
}

void TwinTraffic::move(double to_s, Twin& twin) const {
    const auto elapsed_s = static_cast<float>(to_s - twin.time_s);
    twin.travelled_m += 0.5F * (twin.speed_mps + twin.next_speed_mps) * elapsed_s;
    twin.speed_mps = twin.next_speed_mps;
    twin.time_s = to_s;
    while (twin.at + 1 < twin.path.size() && twin.travelled_m > twin.path[twin.at].road.end_m) {
        ++twin.at;
        twin.lane = twin.path[twin.at].road.lane;
    }
    const roads::RouteStep& step = twin.path[twin.at].road;
    if (twin.travelled_m > step.end_m) {
        twin.travelled_m = step.end_m;
        twin.at_end = twin.ends;
    }
    twin.lane_position_m = twin.travelled_m - step.start_m;
    twin.route_edge = step.route_edge;
}

traffic::MotionState TwinTraffic::state(std::uint32_t row) const {
    const Twin& twin = twin_of(row);
    const roads::Point middle = network_.point_at(twin.seen.lane, core::Metres(twin.seen.lane_position_m));
    const roads::Point place = network_.point_at(twin.lane, core::Metres(twin.lane_position_m));
    return {
        .x_m = place.x_m + twin.filter.mean[0] - middle.x_m,
        .y_m = place.y_m + twin.filter.mean[1] - middle.y_m,
        .heading_rad = static_cast<float>(network_.heading_at(twin.lane, core::Metres(twin.lane_position_m))),
        .speed_mps = twin.speed_mps,
        .lane = twin.lane,
        .lane_position_m = twin.lane_position_m,
        .route_edge = twin.route_edge};
}

float TwinTraffic::driven_m(std::uint32_t row) const {
    const Twin& twin = twin_of(row);
    return twin.before_path_m + twin.travelled_m;
}

bool TwinTraffic::waits(std::uint32_t row) const {
    const Twin& twin = twin_of(row);
    return !twin.path.empty() && twin.lane != twin.path[twin.at].exit_lane;
}

TwinTraffic::Neighbour TwinTraffic::leader_of(const Twin& twin) const {
    const float horizon_m = twin.travelled_m + least_view_m + view_s * twin.speed_mps;
    for (std::size_t at = twin.at; at < twin.path.size(); ++at) {
        if (twin.path[at].road.start_m > horizon_m) break;
        if (const Neighbour next = next_on(twin, at); next.exists) return next;
    }
    return {};
}

TwinTraffic::Neighbour TwinTraffic::follower_of(const Twin& twin) const {
    auto place =
        std::ranges::lower_bound(places_, VehicleOnLane{twin.lane, twin.lane_position_m, twin.key, 0});
    while (place != places_.begin()) {
        --place;
        if (place->lane != twin.lane) return {};
        if (place->key == twin.key) continue;
        const Twin& follower = twins_[place->index];
        return {true, follower.row, twin.lane_position_m - twin.length_m - place->position_m,
                follower.speed_mps};
    }
    return {};
}

TwinTraffic::Surroundings TwinTraffic::surroundings(const traffic::Observation& observation,
                                                    std::uint32_t row) const {
    const Twin& twin = twin_of(row);
    Surroundings around{leader_of(twin), follower_of(twin), {}};
    for (std::size_t at = twin.at; at < twin.path.size(); ++at) {
        const char* const letter = letter_of(observation, twin.path[at].road);
        if (letter == nullptr) continue;
        around.line = {std::max(0.0F, twin.path[at].road.end_m - twin.travelled_m), *letter};
        break;
    }
    return around;
}

float TwinTraffic::seen_sigma_m(std::uint32_t row) const {
    const auto& covariance = twin_of(row).filter.covariance;
    return std::sqrt(0.5F * (covariance[0][0] + covariance[1][1]));
}

}  // namespace clearway::prediction
