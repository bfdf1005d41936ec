#include "prediction/motion_context.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "traffic/signal.hpp"

namespace clearway::prediction {

using detail::VehicleOnLane;

namespace {

/// A vehicle may drive at up to 1.25 times the limit (the largest speed factor in the scenarios), and its
/// report may be late by a step.
constexpr float over_limit = 1.25F;
constexpr float least_reach_m = 10.0F;
/// Leaders farther ahead do not matter for an outage of a minute.
constexpr float leader_horizon_m = 80.0F;
constexpr float newest_weight = 0.3F;
constexpr double new_report_s = 1e-3;
constexpr float slowest_limit_mps = 1.0F;
/// Slower vehicles before a stop line are in its queue.
constexpr float queued_mps = 2.0F;

/// Where a displacement lies on a path: index of the segment and share of its length.
struct OnPath {
    std::size_t segment = 0;
    float share = 0.0F;
};

OnPath on_path(float displacement_m, float reach_m) {
    constexpr auto segments = static_cast<float>(path_points - 1);
    const float place = std::clamp(displacement_m / reach_m, 0.0F, 1.0F) * segments;
    const float segment = std::min(std::floor(place), segments - 1.0F);
    return {static_cast<std::size_t>(segment), place - segment};
}

/// How far a vehicle gets in `time_s` at the speed limits of the lanes on its way.
float free_flow_m(const roads::Network& network, std::span<const roads::RouteStep> steps, float time_s) {
    float reached_m = 0.0F;
    for (const roads::RouteStep& step : steps) {
        const float limit_mps = std::max(slowest_limit_mps, network.lane(step.lane).speed_limit_mps);
        const float lane_s = (step.end_m - reached_m) / limit_mps;
        if (lane_s >= time_s) return reached_m + time_s * limit_mps;
        if (lane_s <= 0.0F) continue;
        time_s -= lane_s;
        reached_m = step.end_m;
    }
    return reached_m;
}

bool on_route(const traffic::VehicleInfo* info, const traffic::MotionState& state) {
    return info != nullptr && info->route.exists() && state.lane.exists();
}

}  // namespace

roads::Point Path::place_at(float displacement_m, float reach_m) const {
    const OnPath at = on_path(displacement_m, reach_m);
    const roads::Point& from = points[at.segment];
    const roads::Point& to = points[at.segment + 1];
    return {from.x_m + at.share * (to.x_m - from.x_m), from.y_m + at.share * (to.y_m - from.y_m)};
}

roads::Point Path::direction_at(float displacement_m, float reach_m) const {
    const OnPath at = on_path(displacement_m, reach_m);
    const float x_m = points[at.segment + 1].x_m - points[at.segment].x_m;
    const float y_m = points[at.segment + 1].y_m - points[at.segment].y_m;
    const float length_m = std::sqrt(x_m * x_m + y_m * y_m) + 1e-6F;
    return {x_m / length_m, y_m / length_m};
}

MotionContextBuilder::MotionContextBuilder(const roads::Network& network, const graph::LinkRules& rules,
                                           StartAtGreen start)
    : network_(network), rules_(rules), start_(start) {}

void MotionContextBuilder::build(const traffic::Observation& observation, const Scene& scene,
                                 std::vector<MotionContext>& ahead) {
    const Tracks& tracks = scene.tracks;
    remember(observation, tracks);
    watch_signals(observation);
    ahead.clear();
    steps_.clear();
    steps_of_.clear();
    ahead_of_row_.assign(tracks.size(), static_cast<std::uint32_t>(tracks.size()));
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        if (tracks.known[row] != 0) continue;
        ahead_of_row_[row] = static_cast<std::uint32_t>(ahead.size());
        MotionContext& entry = ahead.emplace_back();
        entry.row = row;
        look_ahead(observation, tracks, entry);
    }
    list_places(tracks, ahead);
    if (!ahead.empty()) {
        note_neighbours(observation, tracks);
        sort_places();
        measure_lane_speeds(tracks);
        find_neighbours(tracks, ahead);
        // The second round takes into account leaders that the first held behind their own leaders.
        for (int round = 0; round < 2; ++round) {
            hold_behind_leaders(ahead);
            list_places(tracks, ahead);
            find_neighbours(tracks, ahead);
        }
        follow_twins(scene, ahead);
        follow_detections(scene, ahead);
    }
    std::swap(places_before_, place_of_row_);
    places_before_sorted_ = false;
}

/// Both lists are ordered by key.
void MotionContextBuilder::remember(const traffic::Observation& observation, const Tracks& tracks) {
    std::swap(memories_, old_memories_);
    memories_.clear();
    auto old = old_memories_.begin();
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        while (old != old_memories_.end() && old->key < tracks.key[row]) {
            ++old;
        }
        const float speed_mps = tracks.last[row].speed_mps;
        const double report_s = observation.time.value - tracks.age_s[row];
        const bool is_new = old == old_memories_.end() || old->key != tracks.key[row];
        Memory& memory = is_new ? memories_.emplace_back() : memories_.emplace_back(*old);
        memory.key = tracks.key[row];
        if (report_s <= memory.report_s + new_report_s) continue;
        filter_report(tracks.last[row], tracks.sensor_sigma_m[row], report_s, is_new, memory);
        const float kept_mps = is_new ? speed_mps : memory.smoothed_speed_mps;
        memory.smoothed_speed_mps = kept_mps + newest_weight * (speed_mps - kept_mps);
        memory.report_s = report_s;
        memory.neighbours_noted = false;
    }
}

/// A position without error needs no filter: earlier reports add nothing to it.
void MotionContextBuilder::filter_report(const traffic::MotionState& seen, float sigma_m, double report_s,
                                         bool is_new, Memory& memory) {
    constexpr FilterNoise noise;
    if (is_new || sigma_m == 0.0F) {
        start(seen, sigma_m, noise, memory.seen);
        return;
    }
    prediction::follow(seen, sigma_m, static_cast<float>(report_s - memory.report_s), noise, memory.seen);
}

void MotionContextBuilder::watch_signals(const traffic::Observation& observation) {
    const std::vector<std::string>& states = observation.signals.state;
    signal_states_.resize(states.size());
    signal_state_since_s_.resize(states.size());
    for (std::size_t signal = 0; signal < states.size(); ++signal) {
        if (signal_states_[signal] == states[signal]) continue;
        signal_state_since_s_[signal].resize(states[signal].size(), observation.time.value);
        for (std::size_t link = 0; link < states[signal].size(); ++link) {
            const bool same =
                link < signal_states_[signal].size() && signal_states_[signal][link] == states[signal][link];
            if (!same) signal_state_since_s_[signal][link] = observation.time.value;
        }
        signal_states_[signal] = states[signal];
    }
}

void MotionContextBuilder::look_ahead(const traffic::Observation& observation, const Tracks& tracks,
                                      MotionContext& ahead) {
    const std::uint32_t row = ahead.row;
    const traffic::MotionState& last = tracks.last[row];
    const float age_s = tracks.age_s[row];
    const traffic::VehicleInfo* const info = tracks.info[row];
    Steps& steps = steps_of_.emplace_back();
    steps.first = static_cast<std::uint32_t>(steps_.size());
    ahead.smoothed_speed_mps = memories_[row].smoothed_speed_mps;
    const auto& covariance = memories_[row].seen.covariance;
    ahead.sigma_m = std::sqrt(0.5F * (covariance[0][0] + covariance[1][1]));
    ahead.reach_m = std::max(least_reach_m, last.speed_mps * age_s);
    ahead.route_left_m = ahead.reach_m + route_horizon_m;
    if (on_route(info, last)) {
        const float limit_mps = network_.lane(last.lane).speed_limit_mps;
        ahead.reach_m = std::max(ahead.reach_m, over_limit * limit_mps * age_s);
        const bool goes_on = roads::lanes_ahead(network_, observation.roster->route(info->route), last,
                                                core::Metres(ahead.reach_m + route_horizon_m), walked_);
        ahead.route_left_m = ahead.reach_m + route_horizon_m;
        if (!goes_on) ahead.route_left_m = std::min(ahead.route_left_m, walked_.back().end_m);
        ahead.reach_m = std::clamp(ahead.route_left_m, 1.0F, ahead.reach_m);
        steps_.insert(steps_.end(), walked_.begin(), walked_.end());
        find_lines(observation, ahead);
        ahead.free_flow_m = std::min(free_flow_m(network_, walked_, age_s), ahead.reach_m);
        ahead.has_left = tracks.has_left(row);
    }
    steps.count = static_cast<std::uint32_t>(steps_.size()) - steps.first;
    lay_path(tracks, ahead);
    ahead.travelled_m = std::min(last.speed_mps * age_s, ahead.reach_m);
    if (start_.acceleration_mps2 > 0.0F && ahead.line.exists()) {
        const float limit_mps = network_.lane(last.lane).speed_limit_mps;
        ahead.travelled_m = std::clamp(started_m(tracks, ahead, limit_mps), ahead.travelled_m, ahead.reach_m);
    }
    hold_at_red(ahead);
}

/// How far a vehicle that was seen standing has come since its queue began to move.
float MotionContextBuilder::started_m(const Tracks& tracks, const MotionContext& ahead,
                                      float desired_mps) const {
    const float speed_mps = tracks.last[ahead.row].speed_mps;
    if (speed_mps > queued_mps || !traffic::is_green(ahead.line.state)) return 0.0F;
    const float moving_s =
        std::min(tracks.age_s[ahead.row], ahead.line.state_age_s - ahead.line.distance_m / start_.wave_mps);
    if (moving_s <= 0.0F) return 0.0F;
    const float faster_mps = std::max(0.0F, desired_mps - speed_mps);
    const float gaining_s = std::min(moving_s, faster_mps / start_.acceleration_mps2);
    const float reached_mps = speed_mps + start_.acceleration_mps2 * gaining_s;
    return 0.5F * (speed_mps + reached_mps) * gaining_s + reached_mps * (moving_s - gaining_s);
}

void MotionContextBuilder::hold_at_red(MotionContext& ahead) const {
    const auto holds = [&](const LineOnWay& line) {
        return line.exists() && !traffic::is_green(line.state) && line.distance_m < ahead.travelled_m;
    };
    const bool second = !holds(ahead.line) && start_.acceleration_mps2 > 0.0F && holds(ahead.next_line);
    ahead.held_by_signal = second || holds(ahead.line);
    ahead.displacement_m = ahead.travelled_m;
    if (!ahead.held_by_signal) return;
    ahead.held_at_m = second ? ahead.next_line.distance_m : ahead.line.distance_m;
    ahead.displacement_m = ahead.held_at_m;
    ahead.has_left = false;
}

/// On the lanes of `walked_`.
void MotionContextBuilder::find_lines(const traffic::Observation& observation, MotionContext& ahead) const {
    for (const roads::RouteStep& step : walked_) {
        if (!step.signal.exists() || step.end_m < 0.0F) continue;
        if (step.signal.value >= observation.signals.state.size()) continue;
        const std::string& letters = observation.signals.state[step.signal.value];
        if (step.signal_link >= letters.size()) continue;
        const double since_s = signal_state_since_s_[step.signal.value][step.signal_link];
        const LineOnWay line{step.end_m, letters[step.signal_link],
                             static_cast<float>(observation.time.value - since_s)};
        if (ahead.line.exists()) {
            ahead.next_line = line;
            return;
        }
        ahead.line = line;
    }
}

void MotionContextBuilder::lay_path(const Tracks& tracks, MotionContext& ahead) const {
    const traffic::MotionState& last = tracks.last[ahead.row];
    const auto& [seen_x_m, seen_y_m, vx_mps, vy_mps] = memories_[ahead.row].seen.mean;
    const float spacing_m = ahead.reach_m / static_cast<float>(path_points - 1);
    const Steps& steps = steps_of_.back();
    if (steps.count == 0) {
        for (std::size_t i = 0; i < path_points; ++i) {
            const float along_m = spacing_m * static_cast<float>(i);
            ahead.path.points[i] = {seen_x_m + along_m * std::cos(last.heading_rad),
                                    seen_y_m + along_m * std::sin(last.heading_rad)};
        }
        return;
    }
    // A vehicle keeps its offset from the middle of the lane, which noise or a lane change may have given it.
    const roads::Point middle = network_.point_at(last.lane, core::Metres(last.lane_position_m));
    std::uint32_t at = steps.first;
    for (std::size_t i = 0; i < path_points; ++i) {
        const float along_m = spacing_m * static_cast<float>(i);
        while (at + 1 < steps.first + steps.count && steps_[at].end_m < along_m) {
            ++at;
        }
        const roads::Point point =
            network_.point_at(steps_[at].lane, core::Metres(along_m - steps_[at].start_m));
        ahead.path.points[i] = {point.x_m + seen_x_m - middle.x_m, point.y_m + seen_y_m - middle.y_m};
    }
}

void MotionContextBuilder::list_places(const Tracks& tracks, const std::vector<MotionContext>& ahead) {
    place_of_row_.resize(tracks.size());
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        VehicleOnLane& place = place_of_row_[row];
        place = {tracks.last[row].lane, tracks.last[row].lane_position_m, tracks.key[row], row};
        if (tracks.known[row] != 0) continue;
        const std::uint32_t entry = ahead_of_row_[row];
        const float displacement_m = ahead[entry].displacement_m;
        const Steps& steps = steps_of_[entry];
        for (std::uint32_t at = steps.first; at < steps.first + steps.count; ++at) {
            if (steps_[at].end_m < displacement_m && at + 1 < steps.first + steps.count) continue;
            place.lane = steps_[at].lane;
            place.position_m = displacement_m - steps_[at].start_m;
            break;
        }
    }
}

void MotionContextBuilder::sort_places() {
    lane_places_.clear();
    std::ranges::copy_if(place_of_row_, std::back_inserter(lane_places_),
                         [](const VehicleOnLane& place) { return place.lane.exists(); });
    std::ranges::sort(lane_places_);
}

void MotionContextBuilder::measure_lane_speeds(const Tracks& tracks) {
    lane_speed_mps_.assign(tracks.size(), -1.0F);
    for (auto begin = lane_places_.begin(); begin != lane_places_.end();) {
        auto end = begin;
        float sum_mps = 0.0F;
        int known = 0;
        for (; end != lane_places_.end() && end->lane == begin->lane; ++end) {
            if (tracks.known[end->index] == 0) continue;
            sum_mps += tracks.last[end->index].speed_mps;
            ++known;
        }
        for (; begin != end; ++begin) {
            if (known > 0) lane_speed_mps_[begin->index] = sum_mps / static_cast<float>(known);
        }
    }
}

/// The vehicle next ahead in the same lane, or on the lanes that follow along the route, at the previous
/// call.
core::VehicleKey MotionContextBuilder::leader_before(const traffic::Observation& observation,
                                                     const Tracks& tracks, const VehicleOnLane& place) {
    auto next = std::ranges::upper_bound(places_before_, place);
    if (next != places_before_.end() && next->key == place.key) ++next;
    if (next != places_before_.end() && next->lane == place.lane) return next->key;
    const traffic::VehicleInfo* const info = tracks.info[place.index];
    if (!on_route(info, tracks.last[place.index])) return {};
    roads::lanes_ahead(network_, observation.roster->route(info->route), tracks.last[place.index],
                       core::Metres(leader_horizon_m), walked_);
    for (std::size_t at = 1; at < walked_.size(); ++at) {
        const auto first =
            std::ranges::lower_bound(places_before_, VehicleOnLane{walked_[at].lane, -1e9F, {}, 0});
        if (first == places_before_.end() || first->lane != walked_[at].lane) continue;
        return walked_[at].start_m + first->position_m < leader_horizon_m ? first->key : core::VehicleKey{};
    }
    return {};
}

/// For vehicles that fell silent now: notes the vehicles ahead and behind when they were last heard.
void MotionContextBuilder::note_neighbours(const traffic::Observation& observation, const Tracks& tracks) {
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        Memory& memory = memories_[row];
        if (tracks.known[row] != 0 || memory.neighbours_noted) continue;
        if (!places_before_sorted_) std::ranges::sort(places_before_);
        places_before_sorted_ = true;
        memory.neighbours_noted = true;
        memory.leader = {};
        memory.follower = {};
        const VehicleOnLane place{tracks.last[row].lane, tracks.last[row].lane_position_m, memory.key, row};
        if (!place.lane.exists()) continue;
        memory.leader = leader_before(observation, tracks, place);
        auto behind = std::ranges::lower_bound(
            places_before_, VehicleOnLane{place.lane, place.position_m, core::VehicleKey{0}, 0});
        while (behind != places_before_.begin()) {
            --behind;
            if (behind->lane != place.lane) break;
            if (behind->key == memory.key) continue;
            if (place.position_m - behind->position_m < leader_horizon_m) memory.follower = behind->key;
            break;
        }
    }
}

// NOLINTNEXTLINE(readability-function-size): whose way, who on it, and what is believed of all
VehicleOnWay MotionContextBuilder::on_way(const Tracks& tracks, const std::vector<MotionContext>& ahead,
                                          core::VehicleKey key,
                                          std::span<const roads::RouteStep> steps) const {
    if (key.value == 0) return {};
    const std::uint32_t row = tracks.row_of(key);
    if (row == tracks.size() || !place_of_row_[row].lane.exists()) return {};
    const std::uint32_t entry = ahead_of_row_[row];
    if (entry < ahead.size() && ahead[entry].has_left) return {};
    const VehicleOnLane& place = place_of_row_[row];
    const core::EdgeIndex edge = network_.lane(place.lane).edge;
    for (const roads::RouteStep& step : steps) {
        if (network_.lane(step.lane).edge != edge) continue;
        const traffic::VehicleInfo* const info = tracks.info[row];
        return {true,
                tracks.known[row] != 0,
                row,
                step.start_m + place.position_m,
                info == nullptr ? 5.0F : info->length_m,
                tracks.last[row].speed_mps};
    }
    return {};
}

void MotionContextBuilder::find_neighbours(const Tracks& tracks, std::vector<MotionContext>& ahead) {
    for (std::size_t entry = 0; entry < ahead.size(); ++entry) {
        const std::span steps = way_of(entry);
        const Memory& memory = memories_[ahead[entry].row];
        ahead[entry].leader = on_way(tracks, ahead, memory.leader, steps);
        ahead[entry].follower = on_way(tracks, ahead, memory.follower, steps);
    }
}

void MotionContextBuilder::hold_behind_leaders(std::vector<MotionContext>& ahead) const {
    constexpr float minimum_gap_m = 2.5F;
    for (MotionContext& entry : ahead) {
        if (!entry.leader.exists) continue;
        const float room_m = entry.leader.distance_m - entry.leader.length_m - minimum_gap_m;
        const float free_m = entry.held_by_signal ? entry.held_at_m : entry.travelled_m;
        entry.held_by_leader = room_m < free_m;
        entry.displacement_m = std::clamp(std::min(free_m, room_m), 0.0F, entry.reach_m);
    }
}

void MotionContextBuilder::follow_twins(const Scene& scene, std::vector<MotionContext>& ahead) const {
    if (scene.twins == nullptr) return;
    for (MotionContext& entry : ahead) {
        entry.drives = scene.twins->is_twin(entry.row);
        if (entry.drives) entry.twin_m = std::clamp(scene.twins->driven_m(entry.row), 0.0F, entry.reach_m);
    }
}

void MotionContextBuilder::follow_detections(const Scene& scene, std::vector<MotionContext>& ahead) {
    const Tracks& tracks = scene.tracks;
    detections_.list(scene);
    for (MotionContext& entry : ahead) {
        const std::span<const detail::Detection> own = detections_.of(entry.row);
        entry.detections = static_cast<std::uint32_t>(std::ranges::count_if(
            own, [&](const detail::Detection& detection) { return tracks.known[detection.from] != 0; }));
        if (entry.detections == 0) continue;
        const auto agreed_m = [&](float believed_m) {
            return detail::agreed_displacement_m(entry, own, tracks, rules_.radius_m, believed_m);
        };
        entry.displacement_m = agreed_m(entry.displacement_m);
        if (entry.drives) entry.twin_m = agreed_m(entry.twin_m);
    }
}

namespace detail {

traffic::MotionState state_after(const roads::Network& network, const traffic::Observation& observation,
                                 const Tracks& tracks, const MotionContext& ahead, float displacement_m) {
    traffic::MotionState state = tracks.last[ahead.row];
    const traffic::VehicleInfo* const info = tracks.info[ahead.row];
    if (on_route(info, state)) {
        state = roads::advance(network, observation.roster->route(info->route), state,
                               core::Metres(displacement_m))
                    .state;
    } else if (displacement_m > 0.0F) {
        state.lane = core::LaneIndex::none();
    }
    const roads::Point place = ahead.place_at(displacement_m);
    state.x_m = place.x_m;
    state.y_m = place.y_m;
    return state;
}

}  // namespace detail

}  // namespace clearway::prediction
