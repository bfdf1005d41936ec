#include "prediction/repair_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prediction/car_following.hpp"
#include "traffic/signal.hpp"

namespace clearway::prediction {
namespace {

/// Stands for a range if the vehicle does not detect the other.
constexpr float not_detected = -2.0F;

/// Indices of the inputs about a stop line.
struct LineInputs {
    std::size_t exists, distance, green, signal_age;
};
constexpr LineInputs line_inputs = {node_input("line"), node_input("line_distance"), node_input("line_green"),
                                    node_input("line_signal_age")};
constexpr LineInputs next_line_inputs = {node_input("next_line"), node_input("next_line_distance"),
                                         node_input("next_line_green"), node_input("next_line_signal_age")};

void write_line(const LineOnWay& line, const LineInputs& inputs, NetInputRow& row) {
    if (!line.exists()) return;
    row.set(inputs.exists, true);
    row.set(inputs.distance, line.distance_m);
    row.set(inputs.green, traffic::is_green(line.state));
    row.set(inputs.signal_age, line.state_age_s);
}

/// Indices of the inputs about another vehicle on the way.
struct VehicleInputs {
    std::size_t exists, known, distance, gap, speed;
};
constexpr VehicleInputs leader_inputs = {node_input("leader"), node_input("leader_known"),
                                         node_input("leader_distance"), node_input("leader_gap"),
                                         node_input("leader_speed")};
constexpr VehicleInputs follower_inputs = {node_input("follower"), node_input("follower_known"),
                                           node_input("follower_distance"), node_input("follower_gap"),
                                           node_input("follower_speed")};

/// Indices of the inputs about a vehicle before or behind the twin.
struct TwinInputs {
    std::size_t exists, age, gap, speed;
};
constexpr TwinInputs twin_leader_inputs = {node_input("twin_leader"), node_input("twin_leader_age"),
                                           node_input("twin_leader_gap"), node_input("twin_leader_speed")};
constexpr TwinInputs twin_follower_inputs = {node_input("twin_follower"), node_input("twin_follower_age"),
                                             node_input("twin_follower_gap"),
                                             node_input("twin_follower_speed")};

void write_vehicle(const VehicleOnWay& vehicle, float displacement_m, const VehicleInputs& inputs,
                   NetInputRow& row) {
    if (!vehicle.exists) return;
    row.set(inputs.exists, true);
    row.set(inputs.known, vehicle.known);
    row.set(inputs.distance, vehicle.distance_m);
    row.set(inputs.gap, vehicle.distance_m - vehicle.length_m - displacement_m);
    row.set(inputs.speed, vehicle.speed_mps);
}

}  // namespace

void RepairInputs::clear() {
    rows = 0;
    nodes.clear();
    x_m.clear();
    y_m.clear();
    place_sigma_m.clear();
    receivers.clear();
    first_edge.assign(1, 0);
    source.clear();
    edges.clear();
    pairs.clear();
    pair_features.clear();
}

RowPair first_end_first(const RepairInputs& inputs, RowPair pair) {
    const auto node = [&](std::uint32_t row) {
        return std::span(inputs.nodes).subspan(row * node_width, node_width);
    };
    const auto left = node(pair.left);
    const auto right = node(pair.right);
    constexpr std::size_t known = node_input("known");
    constexpr std::size_t age = node_input("age");
    const bool swapped = left[known] != right[known] ? left[known] > right[known]
                         : left[age] != right[age]   ? left[age] < right[age]
                                                     : std::ranges::lexicographical_compare(left, right);
    return swapped ? RowPair{pair.right, pair.left} : pair;
}

RepairInputBuilder::RepairInputBuilder(const roads::Network& network, const graph::LinkRules& rules)
    : network_(network), rules_(rules), roads_(network, rules) {}

void RepairInputBuilder::build(const traffic::Observation& observation, const Scene& scene,
                               RepairInputs& inputs) {
    const Tracks& tracks = scene.tracks;
    roads_.build(observation, scene, ahead_);
    inputs.clear();
    if (ahead_.empty()) return;
    inputs.rows = static_cast<std::uint32_t>(tracks.size());
    inputs.radius_m = static_cast<float>(rules_.radius_m);
    inputs.x_m = tracks.x_m;
    inputs.y_m = tracks.y_m;
    place_rows(scene);
    inputs.place_sigma_m = sigma_m_;
    for (const MotionContext& ahead : ahead_)
        inputs.receivers.push_back({ahead.row, ahead.believed_m(), ahead.reach_m, ahead.path});
    look_around(observation, scene);
    write_nodes(observation, scene, inputs);
    write_edges(scene, inputs);
    write_pairs(scene, inputs);
}

void RepairInputBuilder::place_rows(const Scene& scene) {
    const Tracks& tracks = scene.tracks;
    x_m_ = tracks.x_m;
    y_m_ = tracks.y_m;
    rule_x_m_ = tracks.x_m;
    rule_y_m_ = tracks.y_m;
    sigma_m_ = tracks.sensor_sigma_m;
    growth_.resize(tracks.size());
    heading_cosine_.resize(tracks.size());
    heading_sine_.resize(tracks.size());
    lane_.resize(tracks.size());
    lane_position_m_.resize(tracks.size());
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        growth_[row] = tracks.age_s[row] > 0.0F ? twin_growth(tracks.age_s[row], CarFollowingConfig{}) : 0.0F;
        heading_cosine_[row] = std::cos(tracks.last[row].heading_rad);
        heading_sine_[row] = std::sin(tracks.last[row].heading_rad);
        lane_[row] = tracks.last[row].lane;
        lane_position_m_[row] = tracks.last[row].lane_position_m;
    }
    along_.clear();
    ahead_of_row_.assign(tracks.size(), static_cast<std::uint32_t>(ahead_.size()));
    for (std::uint32_t entry = 0; entry < ahead_.size(); ++entry) {
        const MotionContext& ahead = ahead_[entry];
        ahead_of_row_[ahead.row] = entry;
        along_.push_back(ahead.direction_at(ahead.believed_m()));
        const roads::Point place = ahead.place_at(ahead.believed_m());
        x_m_[ahead.row] = place.x_m;
        y_m_[ahead.row] = place.y_m;
        const roads::Point by_rule = ahead.place_at(ahead.displacement_m);
        rule_x_m_[ahead.row] = by_rule.x_m;
        rule_y_m_[ahead.row] = by_rule.y_m;
        sigma_m_[ahead.row] = ahead.sigma_m;
        lane_[ahead.row] = ahead.drives ? scene.twins->lane(ahead.row) : core::LaneIndex::none();
        lane_position_m_[ahead.row] = ahead.drives ? scene.twins->lane_position_m(ahead.row) : 0.0F;
    }
}

void RepairInputBuilder::look_around(const traffic::Observation& observation, const Scene& scene) {
    around_.clear();
    if (beside_.size() < ahead_.size()) beside_.resize(ahead_.size());
    for (const MotionContext& ahead : ahead_) {
        around_.push_back(ahead.drives ? scene.twins->surroundings(observation, ahead.row)
                                       : TwinTraffic::Surroundings{});
        const TwinTraffic::Surroundings& around = around_.back();
        std::vector<std::uint32_t>& beside = beside_[around_.size() - 1];
        beside.clear();
        const auto add = [&](bool exists, std::uint32_t row) {
            if (exists && !core::contains(beside, row)) beside.push_back(row);
        };
        add(ahead.leader.exists, ahead.leader.row);
        add(ahead.follower.exists, ahead.follower.row);
        add(around.leader.exists, around.leader.row);
        add(around.follower.exists, around.follower.row);
    }
}

void RepairInputBuilder::write_nodes(const traffic::Observation& observation, const Scene& scene,
                                     RepairInputs& inputs) {
    const Tracks& tracks = scene.tracks;
    inputs.nodes.assign(tracks.size() * node_width, 0.0F);
    for (std::uint32_t at = 0; at < tracks.size(); ++at) {
        NetInputRow row(node_inputs, std::span(inputs.nodes).subspan(at * node_width, node_width));
        const float speed_mps = tracks.last[at].speed_mps;
        const float smoothed_mps = roads_.smoothed_speed_mps(at);
        row.set(node_input("known"), tracks.known[at] != 0);
        row.set(node_input("automated"), tracks.vehicle_class[at] == traffic::VehicleClass::automated);
        row.set(node_input("emergency"), tracks.vehicle_class[at] == traffic::VehicleClass::emergency);
        row.set(node_input("speed"), speed_mps);
        row.set(node_input("smoothed_speed"), smoothed_mps);
        row.set(node_input("speed_change"), speed_mps - smoothed_mps);
        if (ahead_of_row_[at] == ahead_.size()) continue;
        const MotionContext& ahead = ahead_[ahead_of_row_[at]];
        write_motion(scene, ahead, row);
        write_line(ahead.line, line_inputs, row);
        write_line(ahead.next_line, next_line_inputs, row);
        write_vehicle(ahead.leader, ahead.believed_m(), leader_inputs, row);
        write_vehicle(ahead.follower, ahead.believed_m(), follower_inputs, row);
        write_neighbours(observation, scene, ahead, row);
        if (ahead.drives) write_twin(scene, ahead_of_row_[at], row);
    }
}

void RepairInputBuilder::write_motion(const Scene& scene, const MotionContext& ahead,
                                      NetInputRow& row) const {
    const float age_s = scene.tracks.age_s[ahead.row];
    const traffic::MotionState& last = scene.tracks.last[ahead.row];
    const float limit_mps = last.lane.exists() ? network_.lane(last.lane).speed_limit_mps : last.speed_mps;
    row.set(node_input("age"), age_s);
    row.set(node_input("log_age"), std::log1p(age_s));
    row.set(node_input("speed_limit"), limit_mps);
    row.set(node_input("travelled"), ahead.travelled_m);
    row.set(node_input("displacement"), ahead.displacement_m);
    row.set(node_input("reach"), ahead.reach_m);
    row.set(node_input("free_flow"), ahead.free_flow_m);
    if (ahead.line.exists()) {
        row.set(node_input("report_to_signal_change"), age_s - ahead.line.state_age_s);
        row.set(node_input("travelled_past_line"), ahead.travelled_m - ahead.line.distance_m);
    }
    row.set(node_input("route_left"), ahead.route_left_m - ahead.displacement_m);
    row.set(node_input("place_sigma"), ahead.sigma_m);
}

void RepairInputBuilder::write_neighbours(const traffic::Observation& observation, const Scene& scene,
                                          const MotionContext& ahead, NetInputRow& row) const {
    const Tracks& tracks = scene.tracks;
    const traffic::MotionState& last = tracks.last[ahead.row];
    row.set(node_input("past_end"), tracks.past_end_m[ahead.row] > 0.0F);
    row.set(node_input("has_left"), ahead.has_left);
    row.set(node_input("exits_known"), observation.exits_known);
    row.set(node_input("detections"), static_cast<float>(ahead.detections));
    row.set(node_input("held_by_signal"), ahead.held_by_signal);
    row.set(node_input("held_by_leader"), ahead.held_by_leader);
    const float traffic_mps = roads_.lane_speed_mps()[ahead.row];
    row.set(node_input("lane_has_traffic"), traffic_mps >= 0.0F);
    row.set(node_input("lane_speed"), std::max(0.0F, traffic_mps));
    row.set(node_input("inside_junction"),
            last.lane.exists() && network_.edge(network_.lane(last.lane).edge).internal);
    row.set(node_input("fresh"), tracks.freshness[ahead.row] == traffic::Freshness::fresh);
}

void RepairInputBuilder::write_twin(const Scene& scene, std::size_t entry, NetInputRow& row) const {
    const TwinTraffic& twins = *scene.twins;
    const std::uint32_t own = ahead_[entry].row;
    const TwinTraffic::Surroundings& around = around_[entry];
    row.set(node_input("twin"), true);
    row.set(node_input("twin_displacement"), ahead_[entry].twin_m);
    row.set(node_input("twin_speed"), twins.speed_mps(own));
    if (twins.lane(own).exists())
        row.set(node_input("twin_limit"), network_.lane(twins.lane(own)).speed_limit_mps);
    row.set(node_input("twin_waits"), twins.waits(own));
    row.set(node_input("twin_at_end"), twins.at_end(own));
    if (around.line.distance_m >= 0.0F) {
        row.set(node_input("twin_line"), true);
        row.set(node_input("twin_line_distance"), around.line.distance_m);
        row.set(node_input("twin_line_green"), traffic::is_green(around.line.state));
    }
    const auto write = [&](const TwinTraffic::Neighbour& neighbour, const TwinInputs& inputs) {
        if (!neighbour.exists) return;
        row.set(inputs.exists, true);
        row.set(inputs.age, scene.tracks.age_s[neighbour.row]);
        row.set(inputs.gap, neighbour.gap_m);
        row.set(inputs.speed, neighbour.speed_mps);
    };
    write(around.leader, twin_leader_inputs);
    write(around.follower, twin_follower_inputs);
}

/// A receiver hears those near it, those that detect it, and those before and behind it: when it was last
/// heard, and of its twin.
void RepairInputBuilder::write_edges(const Scene& scene, RepairInputs& inputs) {
    proximity_.build_all_pairs({x_m_, y_m_, scene.tracks.vehicle_class}, message_radius_m, near_);
    for (std::size_t entry = 0; entry < ahead_.size(); ++entry) {
        const std::uint32_t row = ahead_[entry].row;
        const std::span<const detail::Detection> detections = roads_.detections().of(row);
        add_nearest(scene, entry, detections, inputs);
        for (const detail::Detection& detection : detections)
            add_edge(scene, entry, detection.from, detection.range_m, inputs);
        for (const std::uint32_t source : beside_[entry]) {
            if (source != row && !detects(detections, source))
                add_edge(scene, entry, source, not_detected, inputs);
        }
        inputs.first_edge.push_back(static_cast<std::uint32_t>(inputs.source.size()));
    }
}

bool RepairInputBuilder::detects(std::span<const detail::Detection> detections, std::uint32_t source) {
    return core::contains(detections, source, &detail::Detection::from);
}

/// The nearest vehicles but those that get an edge for another reason.
void RepairInputBuilder::add_nearest(const Scene& scene, std::size_t entry,
                                     std::span<const detail::Detection> detections, RepairInputs& inputs) {
    nearest_.clear();
    const auto neighbours = near_.neighbours_of(ahead_[entry].row);
    const auto distances = near_.distances_of(ahead_[entry].row);
    for (std::size_t at = 0; at < neighbours.size(); ++at) {
        const std::uint32_t source = neighbours[at];
        const bool apart = core::contains(beside_[entry], source) || detects(detections, source);
        if (!apart) nearest_.push_back({distances[at], source});
    }
    const std::size_t kept = std::min(most_near_sources, nearest_.size());
    std::ranges::partial_sort(nearest_, nearest_.begin() + static_cast<std::ptrdiff_t>(kept));
    for (std::size_t at = 0; at < kept; ++at) {
        add_edge(scene, entry, nearest_[at].row, not_detected, inputs);
    }
}

/// `range_m`: measured, -1 for presence alone, or `not_detected`.
void RepairInputBuilder::add_edge(const Scene& scene, std::size_t entry, std::uint32_t source, float range_m,
                                  RepairInputs& inputs) {
    const Tracks& tracks = scene.tracks;
    const MotionContext& ahead = ahead_[entry];
    const std::uint32_t row = ahead.row;
    inputs.source.push_back(source);
    inputs.edges.resize(inputs.source.size() * edge_width, 0.0F);
    const traffic::MotionState& last = tracks.last[source];
    NetInputRow out(edge_inputs, std::span(inputs.edges).last(edge_width));
    const float distance_m = write_place(entry, source, out);
    const roads::Point along = along_[entry];
    const float cosine = along.x_m * heading_cosine_[source] + along.y_m * heading_sine_[source];
    out.set(edge_input("cosine"), cosine);
    out.set(edge_input("sine"), along.x_m * heading_sine_[source] - along.y_m * heading_cosine_[source]);
    out.set(edge_input("speed"), last.speed_mps);
    out.set(edge_input("relative_speed"), last.speed_mps * cosine - tracks.last[row].speed_mps);
    out.set(edge_input("known"), tracks.known[source] != 0);
    out.set(edge_input("age"), tracks.age_s[source]);
    out.set(edge_input("is_leader"), ahead.leader.exists && ahead.leader.row == source);
    out.set(edge_input("is_follower"), ahead.follower.exists && ahead.follower.row == source);
    out.set(edge_input("detects"), range_m != not_detected);
    out.set(edge_input("range_measured"), range_m >= 0.0F);
    if (range_m >= 0.0F) out.set(edge_input("range_error"), distance_m - range_m);
    // Distance ahead of where the receiver was last seen: tells which of two vehicles in a lane is ahead.
    if (last.lane.exists() && last.lane == tracks.last[row].lane) {
        out.set(edge_input("same_lane"), true);
        out.set(edge_input("lane_lead"), last.lane_position_m - tracks.last[row].lane_position_m);
    }
    out.set(edge_input("emergency"), tracks.vehicle_class[source] == traffic::VehicleClass::emergency);
    const TwinTraffic::Surroundings& around = around_[entry];
    out.set(edge_input("twin_leads"), around.leader.exists && around.leader.row == source);
    out.set(edge_input("twin_follows"), around.follower.exists && around.follower.row == source);
}

/// Where the source is believed to be, seen from the receiver, in the plane and along the receiver's way.
float RepairInputBuilder::write_place(std::size_t entry, std::uint32_t source, NetInputRow& out) const {
    const MotionContext& ahead = ahead_[entry];
    const roads::Point along = along_[entry];
    const float x_m = x_m_[source] - x_m_[ahead.row];
    const float y_m = y_m_[source] - y_m_[ahead.row];
    const float left_m = along.x_m * y_m - along.y_m * x_m;
    out.set(edge_input("ahead"), along.x_m * x_m + along.y_m * y_m);
    out.set(edge_input("left"), left_m);
    out.set(edge_input("left_near"), left_m);
    const float distance_m = std::hypot(x_m, y_m);
    out.set(edge_input("distance"), distance_m);
    if (!lane_[source].exists()) return distance_m;
    for (const roads::RouteStep& step : roads_.way_of(entry)) {
        if (step.lane != lane_[source]) continue;
        out.set(edge_input("on_way"), true);
        out.set(edge_input("way_lead"), step.start_m + lane_position_m_[source] - ahead.believed_m());
        break;
    }
    return distance_m;
}

void RepairInputBuilder::write_pairs(const Scene& scene, RepairInputs& inputs) {
    const Tracks& tracks = scene.tracks;
    const PairList& list = scene.candidates;
    inputs.pairs = list.rows;
    inputs.pair_features.assign(list.size() * pair_width, 0.0F);
    const std::size_t judged = scene.detected.size() + list.size();
    for (std::size_t at = 0; at < list.size(); ++at) {
        const auto [left, right] = list.rows[at];
        NetInputRow out(pair_inputs, std::span(inputs.pair_features).subspan(at * pair_width, pair_width));
        out.set(pair_input("last_seen"), list.last_seen_m[at]);
        out.set(pair_input("dead_reckoned"), list.dead_reckoned_m[at]);
        out.set(pair_input("by_rule"),
                std::hypot(rule_x_m_[left] - rule_x_m_[right], rule_y_m_[left] - rule_y_m_[right]));
        out.set(pair_input("both_missing"), tracks.known[left] == 0 && tracks.known[right] == 0);
        out.set(pair_input("age_younger"), std::min(tracks.age_s[left], tracks.age_s[right]));
        out.set(pair_input("age_older"), std::max(tracks.age_s[left], tracks.age_s[right]));
        out.set(pair_input("heading_cosine"),
                std::cos(tracks.last[left].heading_rad - tracks.last[right].heading_rad));
        const core::LaneIndex left_lane = tracks.last[left].lane;
        const core::LaneIndex right_lane = tracks.last[right].lane;
        const bool on_lanes = left_lane.exists() && right_lane.exists();
        out.set(pair_input("same_edge"),
                on_lanes && network_.lane(left_lane).edge == network_.lane(right_lane).edge);
        out.set(pair_input("same_lane"), on_lanes && left_lane == right_lane);
        out.set(pair_input("follows"), follows(left, right) || follows(right, left));
        write_twins(list.rows[at], out);
        write_meeting(first_end_first(inputs, list.rows[at]), out);
        // If some links survive at all, a pair that is not detected is less likely to be linked.
        if (scene.detected.rows.empty()) continue;
        out.set(pair_input("any_detection"), true);
        out.set(pair_input("detected_share"),
                static_cast<float>(scene.detected.size()) / static_cast<float>(judged));
    }
}

void RepairInputBuilder::write_twins(RowPair pair, NetInputRow& out) const {
    constexpr CarFollowingConfig twin;
    const auto [left, right] = pair;
    const float distance_m = std::hypot(x_m_[left] - x_m_[right], y_m_[left] - y_m_[right]);
    const float inside_m = static_cast<float>(rules_.radius_m) - distance_m;
    const float sensors_m = std::hypot(sigma_m_[left], sigma_m_[right]) / deviation_of_spread;
    const float spread_m = twin_spread_of(growth_[left], growth_[right], twin);
    out.set(pair_input("by_twin"), distance_m);
    out.set(pair_input("inside"), inside_m);
    out.set(pair_input("twin_logit"),
            twin_link_logit(inside_m + static_cast<float>(twin.bias_m), sensors_m, spread_m, twin));
    out.set(pair_input("twin_same_lane"), lane_[left].exists() && lane_[left] == lane_[right]);
    out.set(pair_input("radius"), static_cast<float>(rules_.radius_m));
}

/// `ends.left` is the first end. Both have been heard just now in no pair.
void RepairInputBuilder::write_meeting(RowPair ends, NetInputRow& out) const {
    const std::uint32_t entry = ahead_of_row_[ends.left];
    const roads::Point to{x_m_[ends.right], y_m_[ends.right]};
    const auto radius_m = static_cast<float>(rules_.radius_m);
    float nearest_m2 = std::numeric_limits<float>::max();
    int within = 0;
    for (const roads::Point point : ahead_[entry].path.points) {
        const float x_m = point.x_m - to.x_m;
        const float y_m = point.y_m - to.y_m;
        const float away_m2 = x_m * x_m + y_m * y_m;
        nearest_m2 = std::min(nearest_m2, away_m2);
        within += away_m2 < radius_m * radius_m ? 1 : 0;
    }
    const roads::Point along = along_[entry];
    const float x_m = to.x_m - x_m_[ends.left];
    const float y_m = to.y_m - y_m_[ends.left];
    out.set(pair_input("nearest"), std::sqrt(nearest_m2));
    out.set(pair_input("share_within"), static_cast<float>(within) / static_cast<float>(path_points));
    out.set(pair_input("ahead"), along.x_m * x_m + along.y_m * y_m);
    out.set(pair_input("left"), along.x_m * y_m - along.y_m * x_m);
}

bool RepairInputBuilder::follows(std::uint32_t one, std::uint32_t other) const {
    if (ahead_of_row_[one] == ahead_.size()) return false;
    const MotionContext& ahead = ahead_[ahead_of_row_[one]];
    return (ahead.leader.exists && ahead.leader.row == other) ||
           (ahead.follower.exists && ahead.follower.row == other);
}

}  // namespace clearway::prediction
