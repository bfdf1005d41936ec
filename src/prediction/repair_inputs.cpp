#include "prediction/repair_inputs.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "traffic/signal.hpp"

namespace clearway::prediction {
namespace {

constexpr float speed_unit_mps = 15.0F;
constexpr float length_unit_m = 50.0F;
/// In place of a range where a vehicle does not detect the other.
constexpr float not_detected = -2.0F;

float flag(bool condition) {
    return condition ? 1.0F : 0.0F;
}

float within(float value, float most) {
    return std::clamp(value, -most, most);
}

/// Writes numbers one after the other into a row that is all zero at first.
class RowWriter {
  public:
    explicit RowWriter(std::span<float> row) : row_(row) {}
    void put(float value) {
        assert(at_ < row_.size());
        assert(std::isfinite(value));
        row_[at_++] = value;
    }
    void put(bool condition) { put(flag(condition)); }
    void skip(std::size_t count) { at_ += count; }

  private:
    std::span<float> row_;
    std::size_t at_ = 0;
};

void put_line_on_way(RowWriter& out, const LineOnWay& line) {
    out.put(line.exists());
    if (!line.exists()) {
        out.skip(3);
        return;
    }
    out.put(within(line.distance_m / 100.0F, 4.0F));
    out.put(traffic::is_green(line.letter));
    out.put(std::min(line.letter_age_s, 60.0F) / 20.0F);
}

void put_vehicle_on_way(RowWriter& out, const VehicleOnWay& vehicle, float displacement_m) {
    out.put(vehicle.exists);
    if (!vehicle.exists) {
        out.skip(4);
        return;
    }
    out.put(vehicle.known);
    out.put(within(vehicle.distance_m / length_unit_m, 6.0F));
    out.put(within((vehicle.distance_m - vehicle.length_m - displacement_m) / length_unit_m, 4.0F));
    out.put(vehicle.speed_mps / speed_unit_mps);
}

}  // namespace

FeatureSchema repair_schema() {
    return {"repair", 2, node_width};
}

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
        const RoadAhead& ahead = ahead_[entry];
        ahead_of_row_[ahead.row] = entry;
        const roads::Point place = ahead.place_at(ahead.displacement_m);
        x_m_[ahead.row] = place.x_m;
        y_m_[ahead.row] = place.y_m;
        inputs.place_sigma_m[ahead.row] = ahead.sigma_m;
        inputs.receivers.push_back({ahead.row, ahead.displacement_m, ahead.reach_m, -1.0F, ahead.path});
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
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        const std::span<float> numbers = std::span(inputs.nodes).subspan(row * node_width, node_width);
        RowWriter out(numbers);
        const traffic::MotionState& last = tracks.last[row];
        out.put(tracks.known[row] != 0);
        out.put(tracks.vehicle_class[row] == traffic::VehicleClass::automated);
        out.put(tracks.vehicle_class[row] == traffic::VehicleClass::emergency);
        out.put(within(last.speed_mps / speed_unit_mps, 4.0F));
        out.put(within(roads_.smoothed_speed_mps(row) / speed_unit_mps, 4.0F));
        out.put(within((last.speed_mps - roads_.smoothed_speed_mps(row)) / 5.0F, 3.0F));
        if (ahead_of_row_[row] == ahead_.size()) continue;
        write_receiver_features(observation, scene, ahead_[ahead_of_row_[row]], numbers.subspan(6));
    }
}

void RepairInputBuilder::write_receiver_features(const traffic::Observation& observation, const Scene& scene,
                                                 const RoadAhead& ahead, std::span<float> numbers) {
    const Tracks& tracks = scene.tracks;
    const std::uint32_t row = ahead.row;
    const float age_s = tracks.age_s[row];
    const traffic::MotionState& last = tracks.last[row];
    RowWriter out(numbers);
    out.put(std::min(age_s / 10.0F, 6.0F));
    out.put(std::log1p(age_s) / 3.0F);
    const float limit_mps = last.lane.exists() ? network_.lane(last.lane).speed_limit_mps : last.speed_mps;
    out.put(within(limit_mps / speed_unit_mps, 4.0F));
    out.put(within(ahead.travelled_m / 100.0F, 4.0F));
    out.put(within(ahead.displacement_m / 100.0F, 4.0F));
    out.put(within(ahead.reach_m / 200.0F, 4.0F));
    out.put(within(ahead.free_flow_m / 100.0F, 4.0F));
    put_line_on_way(out, ahead.line);
    put_line_on_way(out, ahead.next_line);
    out.put(ahead.line.exists() ? within((age_s - ahead.line.letter_age_s) / 10.0F, 3.0F) : 0.0F);
    out.put(ahead.line.exists() ? within((ahead.travelled_m - ahead.line.distance_m) / 100.0F, 3.0F) : 0.0F);
    put_vehicle_on_way(out, ahead.leader, ahead.displacement_m);
    put_vehicle_on_way(out, ahead.follower, ahead.displacement_m);
    out.put(within((ahead.route_left_m - ahead.displacement_m) / 100.0F, 4.0F));
    out.put(tracks.past_end_m[row] > 0.0F);
    out.put(ahead.has_left);
    out.put(observation.exits_known);
    out.put(within(ahead.sigma_m / 5.0F, 4.0F));
    out.put(std::min(static_cast<float>(ahead.detections) / 4.0F, 3.0F));
    out.put(ahead.held_by_signal);
    out.put(ahead.held_by_leader);
    const float traffic_mps = roads_.lane_speed_mps()[row];
    out.put(traffic_mps >= 0.0F);
    out.put(std::max(0.0F, traffic_mps) / speed_unit_mps);
    out.put(last.lane.exists() && network_.edge(network_.lane(last.lane).edge).internal);
    out.put(tracks.freshness[row] == traffic::Freshness::fresh);
}

void RepairInputBuilder::write_edges(const Scene& scene, RepairInputs& inputs) {
    proximity_.build_all_pairs({x_m_, y_m_, scene.tracks.vehicle_class}, message_radius_m, near_);
    auto first = detectors_.begin();
    for (const RoadAhead& ahead : ahead_) {
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
void RepairInputBuilder::add_nearest(const Scene& scene, const RoadAhead& ahead,
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
void RepairInputBuilder::add_edge(const Scene& scene, const RoadAhead& ahead, std::uint32_t source,
                                  float range_m, RepairInputs& inputs) {
    const Tracks& tracks = scene.tracks;
    const std::uint32_t row = ahead.row;
    inputs.source.push_back(source);
    inputs.edges.resize(inputs.source.size() * edge_width, 0.0F);
    RowWriter out(std::span(inputs.edges).last(edge_width));
    const roads::Point along = ahead.direction_at(ahead.displacement_m);
    const float x_m = x_m_[source] - x_m_[row];
    const float y_m = y_m_[source] - y_m_[row];
    const float distance_m = std::sqrt(x_m * x_m + y_m * y_m);
    const float ahead_m = along.x_m * x_m + along.y_m * y_m;
    const float left_m = along.x_m * y_m - along.y_m * x_m;
    const traffic::MotionState& last = tracks.last[source];
    const bool known = tracks.known[source] != 0;
    const float cosine = along.x_m * std::cos(last.heading_rad) + along.y_m * std::sin(last.heading_rad);
    const float sine = along.x_m * std::sin(last.heading_rad) - along.y_m * std::cos(last.heading_rad);
    out.put(within(ahead_m / length_unit_m, 3.0F));
    out.put(within(left_m / length_unit_m, 3.0F));
    out.put(within(left_m / 5.0F, 2.0F));
    out.put(std::min(distance_m / length_unit_m, 4.0F));
    out.put(cosine);
    out.put(sine);
    out.put(within(last.speed_mps / speed_unit_mps, 4.0F));
    out.put(within((last.speed_mps * cosine - tracks.last[row].speed_mps) / speed_unit_mps, 4.0F));
    out.put(known);
    out.put(std::min(tracks.age_s[source] / 10.0F, 6.0F));
    out.put(ahead.leader.exists && ahead.leader.row == source);
    out.put(ahead.follower.exists && ahead.follower.row == source);
    out.put(range_m != not_detected);
    out.put(range_m >= 0.0F);
    out.put(range_m >= 0.0F ? within((distance_m - range_m) / length_unit_m, 3.0F) : 0.0F);
    const bool same_lane = last.lane.exists() && last.lane == tracks.last[row].lane;
    out.put(same_lane);
    // Seen ahead of the place where the receiver was last seen: for those in one lane, who is first.
    out.put(same_lane
                ? within((last.lane_position_m - tracks.last[row].lane_position_m) / length_unit_m, 3.0F)
                : 0.0F);
    out.put(tracks.vehicle_class[source] == traffic::VehicleClass::emergency);
}

void RepairInputBuilder::write_pairs(const Scene& scene, RepairInputs& inputs) {
    const Tracks& tracks = scene.tracks;
    const PairList& list = scene.candidates;
    inputs.pairs = list.rows;
    inputs.pair_features.assign(list.size() * pair_width, 0.0F);
    for (std::size_t at = 0; at < list.size(); ++at) {
        const auto [left, right] = list.rows[at];
        RowWriter out(std::span(inputs.pair_features).subspan(at * pair_width, pair_width));
        const float x_m = x_m_[left] - x_m_[right];
        const float y_m = y_m_[left] - y_m_[right];
        const float younger_s = std::min(tracks.age_s[left], tracks.age_s[right]);
        const float older_s = std::max(tracks.age_s[left], tracks.age_s[right]);
        const bool both_missing = tracks.known[left] == 0 && tracks.known[right] == 0;
        out.put(std::min(list.last_seen_m[at] / length_unit_m, 4.0F));
        out.put(std::min(list.dead_reckoned_m[at] / length_unit_m, 4.0F));
        out.put(std::min(std::sqrt(x_m * x_m + y_m * y_m) / length_unit_m, 4.0F));
        out.put(both_missing);
        out.put(std::min(younger_s / 10.0F, 6.0F));
        out.put(std::min(older_s / 10.0F, 6.0F));
        out.put(std::cos(tracks.last[left].heading_rad - tracks.last[right].heading_rad));
        const core::LaneIndex left_lane = tracks.last[left].lane;
        const core::LaneIndex right_lane = tracks.last[right].lane;
        const bool on_lanes = left_lane.exists() && right_lane.exists();
        out.put(on_lanes && network_.lane(left_lane).edge == network_.lane(right_lane).edge);
        out.put(on_lanes && left_lane == right_lane);
        const auto follows = [&](std::uint32_t one, std::uint32_t other) {
            if (ahead_of_row_[one] == ahead_.size()) return false;
            const RoadAhead& ahead = ahead_[ahead_of_row_[one]];
            return (ahead.leader.exists && ahead.leader.row == other) ||
                   (ahead.follower.exists && ahead.follower.row == other);
        };
        out.put(follows(left, right) || follows(right, left));
        // Where links survive at all, a pair that no one detects is less likely to be one.
        out.put(!scene.detected.rows.empty());
        out.put(scene.detected.rows.empty() ? 0.0F
                                            : static_cast<float>(scene.detected.size()) /
                                                  static_cast<float>(scene.detected.size() + list.size()));
    }
}

}  // namespace clearway::prediction
