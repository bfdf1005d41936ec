#include "prediction/repair_inputs.hpp"

#include <algorithm>
#include <cmath>

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

RepairInputBuilder::RepairInputBuilder(const roads::Network& network, const graph::LinkRules& rules)
    : network_(network), roads_(network, rules) {}

void RepairInputBuilder::build(const traffic::Observation& observation, const Scene& scene,
                               RepairInputs& inputs) {
    const Tracks& tracks = scene.tracks;
    roads_.build(observation, scene, ahead_);
    inputs.clear();
    if (ahead_.empty()) return;
    inputs.rows = static_cast<std::uint32_t>(tracks.size());
    inputs.x_m = tracks.x_m;
    inputs.y_m = tracks.y_m;
    inputs.place_sigma_m = tracks.sensor_sigma_m;
    x_m_ = tracks.x_m;
    y_m_ = tracks.y_m;
    ahead_of_row_.assign(tracks.size(), static_cast<std::uint32_t>(ahead_.size()));
    for (std::uint32_t entry = 0; entry < ahead_.size(); ++entry) {
        const MotionContext& ahead = ahead_[entry];
        ahead_of_row_[ahead.row] = entry;
        const roads::Point place = ahead.place_at(ahead.displacement_m);
        x_m_[ahead.row] = place.x_m;
        y_m_[ahead.row] = place.y_m;
        inputs.place_sigma_m[ahead.row] = ahead.sigma_m;
        inputs.receivers.push_back({ahead.row, ahead.displacement_m, ahead.reach_m, ahead.path});
    }
    list_detections(scene);
    write_nodes(observation, scene, inputs);
    write_edges(scene, inputs);
    write_pairs(scene, inputs);
}

void RepairInputBuilder::list_detections(const Scene& scene) {
    detectors_.clear();
    for (std::size_t at = 0; at < scene.detected.size(); ++at) {
        const RowPair pair = scene.detected.rows[at];
        const float range_m = scene.detected_range_m[at];
        if (scene.tracks.known[pair.left] == 0) detectors_.push_back({pair.left, pair.right, range_m});
        if (scene.tracks.known[pair.right] == 0) detectors_.push_back({pair.right, pair.left, range_m});
    }
    std::ranges::sort(detectors_);
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
        write_vehicle(ahead.leader, ahead.displacement_m, leader_inputs, row);
        write_vehicle(ahead.follower, ahead.displacement_m, follower_inputs, row);
        write_neighbours(observation, scene, ahead, row);
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

void RepairInputBuilder::write_edges(const Scene& scene, RepairInputs& inputs) {
    proximity_.build_all_pairs({x_m_, y_m_, scene.tracks.vehicle_class}, message_radius_m, near_);
    auto first = detectors_.begin();
    for (const MotionContext& ahead : ahead_) {
        auto last = first;
        while (last != detectors_.end() && last->row == ahead.row) {
            ++last;
        }
        const std::span<const Detector> detectors(first, last);
        add_nearest(scene, ahead, detectors, inputs);
        for (const Detector& detector : detectors) {
            add_edge(scene, ahead, detector.from, detector.range_m, inputs);
        }
        for (const VehicleOnWay* const other : {&ahead.leader, &ahead.follower}) {
            if (!other->exists || detects(detectors, other->row)) continue;
            add_edge(scene, ahead, other->row, not_detected, inputs);
        }
        inputs.first_edge.push_back(static_cast<std::uint32_t>(inputs.source.size()));
        first = last;
    }
}

bool RepairInputBuilder::detects(std::span<const Detector> detectors, std::uint32_t row) {
    return std::ranges::find(detectors, row, &Detector::from) != detectors.end();
}

/// The nearest vehicles but those that get an edge for another reason.
void RepairInputBuilder::add_nearest(const Scene& scene, const MotionContext& ahead,
                                     std::span<const Detector> detectors, RepairInputs& inputs) {
    nearest_.clear();
    const auto neighbours = near_.neighbours_of(ahead.row);
    const auto distances = near_.distances_of(ahead.row);
    for (std::size_t at = 0; at < neighbours.size(); ++at) {
        const std::uint32_t source = neighbours[at];
        const bool apart = (ahead.leader.exists && ahead.leader.row == source) ||
                           (ahead.follower.exists && ahead.follower.row == source) ||
                           detects(detectors, source);
        if (!apart) nearest_.push_back({distances[at], source});
    }
    const std::size_t kept = std::min(most_near_sources, nearest_.size());
    std::ranges::partial_sort(nearest_, nearest_.begin() + static_cast<std::ptrdiff_t>(kept));
    for (std::size_t at = 0; at < kept; ++at) {
        add_edge(scene, ahead, nearest_[at].row, not_detected, inputs);
    }
}

/// `range_m`: measured, -1 for presence alone, or `not_detected`.
void RepairInputBuilder::add_edge(const Scene& scene, const MotionContext& ahead, std::uint32_t source,
                                  float range_m, RepairInputs& inputs) {
    const Tracks& tracks = scene.tracks;
    const std::uint32_t row = ahead.row;
    inputs.source.push_back(source);
    inputs.edges.resize(inputs.source.size() * edge_width, 0.0F);
    const roads::Point along = ahead.direction_at(ahead.displacement_m);
    const float x_m = x_m_[source] - x_m_[row];
    const float y_m = y_m_[source] - y_m_[row];
    const float distance_m = std::sqrt(x_m * x_m + y_m * y_m);
    const float ahead_m = along.x_m * x_m + along.y_m * y_m;
    const float left_m = along.x_m * y_m - along.y_m * x_m;
    const traffic::MotionState& last = tracks.last[source];
    const float cosine = along.x_m * std::cos(last.heading_rad) + along.y_m * std::sin(last.heading_rad);
    const float sine = along.x_m * std::sin(last.heading_rad) - along.y_m * std::cos(last.heading_rad);
    NetInputRow out(edge_inputs, std::span(inputs.edges).last(edge_width));
    out.set(edge_input("ahead"), ahead_m);
    out.set(edge_input("left"), left_m);
    out.set(edge_input("left_near"), left_m);
    out.set(edge_input("distance"), distance_m);
    out.set(edge_input("cosine"), cosine);
    out.set(edge_input("sine"), sine);
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
        const float x_m = x_m_[left] - x_m_[right];
        const float y_m = y_m_[left] - y_m_[right];
        out.set(pair_input("last_seen"), list.last_seen_m[at]);
        out.set(pair_input("dead_reckoned"), list.dead_reckoned_m[at]);
        out.set(pair_input("by_rule"), std::sqrt(x_m * x_m + y_m * y_m));
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
        // If some links survive at all, a pair that is not detected is less likely to be linked.
        if (scene.detected.rows.empty()) continue;
        out.set(pair_input("any_detection"), true);
        out.set(pair_input("detected_share"),
                static_cast<float>(scene.detected.size()) / static_cast<float>(judged));
    }
}

bool RepairInputBuilder::follows(std::uint32_t one, std::uint32_t other) const {
    if (ahead_of_row_[one] == ahead_.size()) return false;
    const MotionContext& ahead = ahead_[ahead_of_row_[one]];
    return (ahead.leader.exists && ahead.leader.row == other) ||
           (ahead.follower.exists && ahead.follower.row == other);
}

}  // namespace clearway::prediction
