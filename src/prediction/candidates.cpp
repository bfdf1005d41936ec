#include "prediction/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace clearway::prediction {
namespace {

float distance_m(const std::vector<float>& x_m, const std::vector<float>& y_m, RowPair pair) {
    const float across = x_m[pair.left] - x_m[pair.right];
    const float along = y_m[pair.left] - y_m[pair.right];
    return std::sqrt(across * across + along * along);
}

/// At most so many places of a vehicle count: last seen, dead-reckoned, of its twin.
constexpr std::size_t most_graphs = 3;
using Graphs = std::span<const graph::ProximityGraph* const>;

/// Calls `visit(right)` once for every neighbour right > left of the row in any of the graphs, ascending.
template <class Visit>
void for_each_in_any(Graphs graphs, std::uint32_t left, const Visit& visit) {
    std::array<std::span<const core::VehicleIndex>, most_graphs> rest;
    for (std::size_t at = 0; at < graphs.size(); ++at) {
        const auto all = graphs[at]->neighbours_of(left);
        rest[at] = {std::ranges::upper_bound(all, left), all.end()};
    }
    constexpr core::VehicleIndex nobody = std::numeric_limits<core::VehicleIndex>::max();
    for (;;) {
        core::VehicleIndex next = nobody;
        for (const auto& neighbours : rest)
            next = neighbours.empty() ? next : std::min(next, neighbours.front());
        if (next == nobody) return;
        visit(next);
        for (auto& neighbours : rest) {
            if (!neighbours.empty() && neighbours.front() == next) neighbours = neighbours.subspan(1);
        }
    }
}

}  // namespace

void PairList::clear() {
    rows.clear();
    last_seen_m.clear();
    dead_reckoned_m.clear();
}

void PairList::add(RowPair pair, float last_seen_distance_m, float dead_reckoned_distance_m) {
    rows.push_back(pair);
    last_seen_m.push_back(last_seen_distance_m);
    dead_reckoned_m.push_back(dead_reckoned_distance_m);
}

SceneBuilder::SceneBuilder(const roads::Network& network, const graph::LinkRules& rules)
    : network_(network), rules_(rules), reach_(CandidateReach::reported) {}

SceneBuilder::SceneBuilder(const roads::Network& network, const graph::LinkRules& rules, CandidateReach reach)
    : network_(network), rules_(rules), reach_(reach), twins_(std::in_place, network) {}

void SceneBuilder::build(const traffic::Observation& observation, Scene& scene, Want want) {
    dead_reckon(observation, network_, scene.tracks);
    scene.twins = twins_ ? &*twins_ : nullptr;
    if (twins_) twins_->follow(observation, scene.tracks);
    scene.known.clear();
    scene.detected.clear();
    scene.detected_range_m.clear();
    scene.candidates.clear();
    collect_detected(observation, scene);
    if (want == Want::links) sort_pairs(scene);
}

void SceneBuilder::collect_detected(const traffic::Observation& observation, Scene& scene) {
    detections_.clear();
    const Tracks& tracks = scene.tracks;
    for (const traffic::DetectedLink& link : observation.detected_links) {
        const std::uint32_t from = tracks.row_of(link.from);
        const std::uint32_t to = tracks.row_of(link.to);
        if (from == tracks.size() || to == tracks.size() || from == to) continue;
        detections_.push_back({{std::min(from, to), std::max(from, to)}, link.range_m});
    }
    // If both ends detect each other, keep the larger range: a measured one wins over a missing one.
    std::ranges::sort(detections_, std::greater<>{});
    detections_.erase(
        std::unique(detections_.begin(), detections_.end(),
                    [](const Detection& one, const Detection& other) { return one.rows == other.rows; }),
        detections_.end());
    std::ranges::reverse(detections_);
    for (const Detection& detection : detections_) {
        scene.detected.add(detection.rows, distance_m(tracks.last_x_m, tracks.last_y_m, detection.rows),
                           distance_m(tracks.x_m, tracks.y_m, detection.rows));
        scene.detected_range_m.push_back(detection.range_m);
    }
}

void SceneBuilder::sort_pairs(Scene& scene) {
    const Tracks& tracks = scene.tracks;
    graph::LinkRules rules = rules_;
    // If all vehicles are known, nothing beyond the link radius matters.
    if (!tracks.all_known) rules.radius_m = candidate_reach_m(rules_);
    builder_.build({tracks.x_m, tracks.y_m, tracks.vehicle_class}, rules, near_now_);
    std::array<const graph::ProximityGraph*, most_graphs> graphs = {&near_now_};
    std::size_t count = 1;
    if (!tracks.all_current) {
        builder_.build({tracks.last_x_m, tracks.last_y_m, tracks.vehicle_class}, rules, near_last_);
        graphs[count++] = &near_last_;
    }
    if (reach_ == CandidateReach::twins && !tracks.all_current && !tracks.all_known) {
        place_twins(tracks);
        builder_.build({twin_x_m_, twin_y_m_, tracks.vehicle_class}, rules, near_twins_);
        graphs[count++] = &near_twins_;
    }
    for (std::uint32_t left = 0; left < tracks.size(); ++left) {
        for_each_in_any(Graphs(graphs).first(count), left, [&](std::uint32_t right) {
            take({left, right}, scene);
        });
    }
}

void SceneBuilder::place_twins(const Tracks& tracks) {
    twin_x_m_ = tracks.x_m;
    twin_y_m_ = tracks.y_m;
    for (std::uint32_t row = 0; row < tracks.size(); ++row) {
        if (tracks.age_s[row] <= 0.0F || !twins_->is_twin(row)) continue;
        const traffic::MotionState state = twins_->state(row);
        twin_x_m_[row] = state.x_m;
        twin_y_m_[row] = state.y_m;
    }
}

void SceneBuilder::take(RowPair pair, Scene& scene) const {
    const Tracks& tracks = scene.tracks;
    const float last_m = distance_m(tracks.last_x_m, tracks.last_y_m, pair);
    const float now_m = tracks.all_current ? last_m : distance_m(tracks.x_m, tracks.y_m, pair);
    if (tracks.known[pair.left] != 0 && tracks.known[pair.right] != 0) {
        const auto radius_m = static_cast<float>(rules_.radius_m);
        if (std::min(last_m, now_m) < radius_m) scene.known.add(pair, last_m, now_m);
        return;
    }
    if (!std::ranges::binary_search(scene.detected.rows, pair)) scene.candidates.add(pair, last_m, now_m);
}

void ObservedMessages::build(const Scene& scene, const graph::LinkRules& rules, MessageGraph& graph) {
    sources_.clear();
    targets_.clear();
    const auto add = [&](RowPair pair) {
        sources_.insert(sources_.end(), {pair.left, pair.right});
        targets_.insert(targets_.end(), {pair.right, pair.left});
    };
    const auto radius_m = static_cast<float>(rules.radius_m);
    for (std::size_t at = 0; at < scene.known.size(); ++at) {
        if (scene.known.dead_reckoned_m[at] < radius_m) add(scene.known.rows[at]);
    }
    std::ranges::for_each(scene.detected.rows, add);
    message_graph_from(sources_, targets_, scene.tracks.size(), graph);
}

}  // namespace clearway::prediction
