#include "samples/recorders.hpp"

#include <cmath>
#include <span>
#include <utility>

#include "roads/route.hpp"

namespace clearway::samples {
namespace {

/// Whether the true distance of two observed vehicles is below the radius; a vehicle that has left is linked
/// to nobody.
bool truly_linked(const truth::Snapshot& snapshot, core::VehicleKey left, core::VehicleKey right,
                  double radius_m) {
    const auto left_row = snapshot.row_of(left);
    const auto right_row = snapshot.row_of(right);
    if (!left_row || !right_row) return false;
    return std::hypot(snapshot.x_m[*left_row] - snapshot.x_m[*right_row],
                      snapshot.y_m[*left_row] - snapshot.y_m[*right_row]) < radius_m;
}

}  // namespace

SampleRecorder::SampleRecorder(const roads::Network& network, const graph::LinkRules& rules,
                               const GraphSampleOrigin& origin, std::unique_ptr<sensing::SensorModel> sensor,
                               core::Seconds interval)
    : rules_(rules),
      sensor_(std::move(sensor)),
      scenes_(network, rules),
      writer_(origin),
      interval_s_(interval.value) {}

void SampleRecorder::on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    sensor_->observe(snapshot, roster, observation_);
    if (!observation_.is_report || observation_.time.value < next_s_) return;
    scenes_.build(observation_, scene_);
    if (scene_.candidates.size() == 0) return;
    messages_.build(scene_, rules_, observed_);
    prediction::corrected_features(scene_.tracks, features_);
    writer_.add(sample_of(snapshot));
    next_s_ = observation_.time.value + interval_s_;
}

GraphSample SampleRecorder::sample_of(const truth::Snapshot& snapshot) const {
    GraphSample sample;
    sample.time_s = observation_.time.value;
    sample.vehicle_count = static_cast<std::uint32_t>(scene_.tracks.size());
    sample.features = features_;
    for (std::uint32_t row = 0; row < sample.vehicle_count; ++row) {
        for (std::uint32_t at = observed_.first[row]; at < observed_.first[row + 1]; ++at) {
            if (row < observed_.source[at]) sample.observed_edges.push_back({row, observed_.source[at]});
        }
    }
    const prediction::PairList& pairs = scene_.candidates;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const prediction::RowPair rows = pairs.rows[i];
        const bool linked = truly_linked(snapshot, scene_.tracks.key[rows.left],
                                         scene_.tracks.key[rows.right], rules_.radius_m);
        sample.candidates.push_back(
            {rows.left, rows.right, pairs.dead_reckoned_m[i], static_cast<std::uint8_t>(linked)});
    }
    return sample;
}

RepairSampleRecorder::RepairSampleRecorder(const roads::Network& network, const graph::LinkRules& rules,
                                           const GraphSampleOrigin& origin,
                                           std::unique_ptr<sensing::SensorModel> sensor,
                                           core::Seconds interval)
    : network_(network),
      rules_(rules),
      sensor_(std::move(sensor)),
      scenes_(network, rules),
      inputs_(network, rules),
      rule_(prediction::make_predictor("route_rule", {.network = network, .rules = rules, .model_file = ""})),
      writer_(origin),
      interval_s_(interval.value) {}

void RepairSampleRecorder::on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    sensor_->observe(snapshot, roster, observation_);
    if (!observation_.is_report) return;
    scenes_.build(observation_, scene_);
    // Both remember, so they see every report.
    rule_->predict(observation_, belief_);
    if (observation_.time.value < next_s_) {
        inputs_.remember(observation_, scene_);
        return;
    }
    inputs_.build(observation_, scene_, sample_.inputs);
    if (sample_.inputs.pairs.empty()) return;
    label(snapshot);
    writer_.add(sample_);
    next_s_ = observation_.time.value + interval_s_;
}

void RepairSampleRecorder::label(const truth::Snapshot& snapshot) {
    const prediction::Tracks& tracks = scene_.tracks;
    sample_.time_s = observation_.time.value;
    sample_.linked.clear();
    for (const prediction::RowPair pair : sample_.inputs.pairs) {
        const bool linked =
            truly_linked(snapshot, tracks.key[pair.left], tracks.key[pair.right], rules_.radius_m);
        sample_.linked.push_back(static_cast<std::uint8_t>(linked));
    }
    const std::span<const float> rule = rule_->scores().probability;
    sample_.rule.assign(rule.begin(), rule.end());
    for (prediction::Receiver& receiver : sample_.inputs.receivers) {
        const auto row = snapshot.row_of(tracks.key[receiver.row]);
        const traffic::VehicleInfo* const info = observation_.roster->find(tracks.key[receiver.row]);
        const bool on_route =
            row && info != nullptr && info->route.exists() && tracks.last[receiver.row].lane.exists();
        if (!on_route) continue;
        const auto displacement = roads::distance_ahead(network_, observation_.roster->route(info->route),
                                                        tracks.last[receiver.row], snapshot.motion(*row),
                                                        core::Metres(receiver.reach_m));
        if (displacement) receiver.true_displacement_m = static_cast<float>(displacement->value);
    }
}

PairSampleRecorder::PairSampleRecorder(const roads::Network& network, const graph::LinkRules& rules,
                                       const PairSampleOrigin& origin,
                                       std::unique_ptr<sensing::SensorModel> sensor, core::Seconds interval)
    : rules_(rules),
      sensor_(std::move(sensor)),
      scenes_(network, rules),
      samples_{.origin = origin, .features = {}, .linked = {}},
      interval_s_(interval.value) {}

void PairSampleRecorder::on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    sensor_->observe(snapshot, roster, observation_);
    if (!observation_.is_report || observation_.time.value < next_s_) return;
    scenes_.build(observation_, scene_);
    if (scene_.candidates.size() == 0) return;
    for (std::size_t at = 0; at < scene_.candidates.size(); ++at) {
        const prediction::RowPair rows = scene_.candidates.rows[at];
        samples_.features.push_back(
            prediction::pair_features(scene_, at, static_cast<float>(rules_.radius_m)));
        samples_.linked.push_back(truly_linked(snapshot, scene_.tracks.key[rows.left],
                                               scene_.tracks.key[rows.right], rules_.radius_m)
                                      ? 1
                                      : 0);
    }
    next_s_ = observation_.time.value + interval_s_;
}

PairDatasetRecorder::PairDatasetRecorder(const roads::Network& network, const graph::LinkRules& rules,
                                         const prediction::FeatureSchema& features,
                                         experiment::ListedPairs pairs)
    : network_(network), rules_(rules), feature_count_(features.width), pairs_(pairs) {}

void PairDatasetRecorder::on_step(const truth::Snapshot& snapshot, const traffic::Roster& /*roster*/) {
    builder_.build({snapshot.x_m, snapshot.y_m, snapshot.vehicle_class}, rules_, links_);
    if (links_.link_count() <= most_links_) return;
    most_links_ = links_.link_count();
    take(snapshot);
}

void PairDatasetRecorder::take(const truth::Snapshot& snapshot) {
    time_ = snapshot.time;
    dataset_ = {};
    dataset_.feature_count = feature_count_;
    dataset_.features.resize(snapshot.size() * feature_count_);
    for (std::uint32_t row = 0; row < snapshot.size(); ++row) {
        prediction::as_published_row(
            snapshot.motion(row), snapshot.vehicle_class[row], network_,
            std::span(dataset_.features).subspan(std::size_t{row} * feature_count_, feature_count_));
    }
    graph::LinkRules listed = rules_;
    if (pairs_ == experiment::ListedPairs::candidates) listed.radius_m = prediction::candidate_radius_m;
    builder_.build({snapshot.x_m, snapshot.y_m, snapshot.vehicle_class}, listed, near_);
    for (std::uint32_t row = 0; row < snapshot.size(); ++row) {
        const auto neighbours = near_.neighbours_of(row);
        const auto distances = near_.distances_of(row);
        for (std::size_t i = 0; i < neighbours.size(); ++i) {
            if (neighbours[i] < row) continue;
            dataset_.source.push_back(row);
            dataset_.target.push_back(neighbours[i]);
            dataset_.label.push_back(distances[i] < rules_.radius_m ? 1.0F : 0.0F);
        }
    }
}

}  // namespace clearway::samples
