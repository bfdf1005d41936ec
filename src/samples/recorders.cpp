#include "samples/recorders.hpp"

#include <span>
#include <stdexcept>
#include <utility>

#include "core/counted.hpp"
#include "core/match_rows.hpp"
#include "prediction/comparison/features.hpp"
#include "prediction/comparison/pair_features.hpp"
#include "prediction/predictor.hpp"
#include "prediction/repair_inputs.hpp"
#include "roads/route.hpp"
#include "samples/graph_sample.hpp"
#include "samples/pair_samples.hpp"
#include "samples/repair_sample.hpp"

namespace clearway::samples {
namespace {

SampleOrigin with_features(SampleOrigin origin, const prediction::FeatureSchema& features) {
    origin.features = features;
    return origin;
}

/// For graphsage_corrected.
class GraphSampleRecorder final : public SampleRecorder {
  public:
    explicit GraphSampleRecorder(Setup setup)
        : SampleRecorder(std::move(setup)),
          writer_(with_features(origin(), prediction::corrected_schema())) {}
    std::string write(const std::filesystem::path& file) const override {
        writer_.write(file);
        return core::counted(writer_.sample_count(), "sample");
    }

  private:
    void record(const truth::Snapshot& snapshot) override;

    prediction::ObservedMessages messages_;
    prediction::MessageGraph observed_;
    GraphSampleWriter writer_;
};

void GraphSampleRecorder::record(const truth::Snapshot& /*snapshot*/) {
    messages_.build(scene(), rules(), observed_);
    GraphSample sample;
    sample.time_s = observation().time.value;
    sample.vehicle_count = static_cast<std::uint32_t>(scene().tracks.size());
    prediction::corrected_features(scene().tracks, sample.features);
    for (std::uint32_t row = 0; row < sample.vehicle_count; ++row) {
        for (std::uint32_t at = observed_.first[row]; at < observed_.first[row + 1]; ++at) {
            if (row < observed_.source[at]) sample.observed_edges.push_back({row, observed_.source[at]});
        }
    }
    const prediction::PairList& pairs = scene().candidates;
    for (std::size_t at = 0; at < pairs.size(); ++at) {
        const prediction::RowPair rows = pairs.rows[at];
        sample.candidates.push_back({rows.left, rows.right, pairs.dead_reckoned_m[at], label(rows)});
    }
    writer_.add(sample);
}

/// For graphsage: its inputs, the true displacements, and the route rule's probabilities of the same pairs.
/// Input builder and route rule keep state, so they see every report.
class RepairSampleRecorder final : public SampleRecorder {
  public:
    explicit RepairSampleRecorder(Setup setup)
        : SampleRecorder(std::move(setup), prediction::CandidateReach::twins),
          inputs_(network(), rules()),
          rule_(prediction::make_predictor("route_rule",
                                           {.network = network(), .rules = rules(), .model_file = ""})),
          writer_(with_features(origin(), prediction::repair_schema())) {}
    std::string write(const std::filesystem::path& file) const override {
        writer_.write(file);
        return core::counted(writer_.sample_count(), "sample");
    }

  private:
    void record(const truth::Snapshot& snapshot) override;
    void pass() override;
    float true_displacement_m(const truth::Snapshot& snapshot, const prediction::Receiver& receiver) const;

    prediction::RepairInputBuilder inputs_;
    std::unique_ptr<prediction::Predictor> rule_;
    traffic::BelievedGraph belief_;
    RepairSample sample_;
    RepairSampleWriter writer_;
};

void RepairSampleRecorder::pass() {
    build_scene();
    rule_->predict(observation(), belief_);
    inputs_.remember(observation(), scene());
}

void RepairSampleRecorder::record(const truth::Snapshot& snapshot) {
    rule_->predict(observation(), belief_);
    inputs_.build(observation(), scene(), sample_.inputs);
    sample_.time_s = observation().time.value;
    sample_.linked.clear();
    for (const prediction::RowPair pair : sample_.inputs.pairs)
        sample_.linked.push_back(label(pair));
    const std::span<const float> rule = rule_->scores().probability;
    sample_.rule.assign(rule.begin(), rule.end());
    sample_.true_displacement_m.clear();
    for (const prediction::Receiver& receiver : sample_.inputs.receivers)
        sample_.true_displacement_m.push_back(true_displacement_m(snapshot, receiver));
    writer_.add(sample_);
}

/// Distance along the route from where the vehicle was last seen; negative if it is not defined.
float RepairSampleRecorder::true_displacement_m(const truth::Snapshot& snapshot,
                                                const prediction::Receiver& receiver) const {
    constexpr float no_label = -1.0F;
    const core::VehicleKey key = scene().tracks.key[receiver.row];
    const traffic::MotionState& last = scene().tracks.last[receiver.row];
    const auto row = snapshot.row_of(key);
    const traffic::VehicleInfo* const info = observation().roster->find(key);
    if (!row || info == nullptr || !info->route.exists() || !last.lane.exists()) return no_label;
    const auto displacement = roads::distance_ahead(network(), observation().roster->route(info->route), last,
                                                    snapshot.motion(*row), core::Metres(receiver.reach_m));
    return displacement ? static_cast<float>(displacement->value) : no_label;
}

/// For the logistic pair model.
class PairSampleRecorder final : public SampleRecorder {
  public:
    explicit PairSampleRecorder(Setup setup) : SampleRecorder(std::move(setup)) {
        samples_.origin = with_features(origin(), prediction::pair_feature_schema());
    }
    std::string write(const std::filesystem::path& file) const override {
        write_pair_samples(file, samples_);
        return core::counted(samples_.linked.size(), "pair");
    }

  private:
    void record(const truth::Snapshot& snapshot) override;

    PairSampleFile samples_;
};

void PairSampleRecorder::record(const truth::Snapshot& /*snapshot*/) {
    for (std::size_t at = 0; at < scene().candidates.size(); ++at) {
        samples_.features.push_back(
            prediction::pair_features(scene(), at, static_cast<float>(rules().radius_m)));
        samples_.linked.push_back(label(scene().candidates.rows[at]));
    }
}

}  // namespace

SampleRecorder::SampleRecorder(Setup setup, std::optional<prediction::CandidateReach> twins)
    : network_(setup.network),
      origin_(std::move(setup.origin)),
      sensor_(std::move(setup.sensor)),
      scenes_(twins ? prediction::SceneBuilder(setup.network, setup.rules, *twins)
                    : prediction::SceneBuilder(setup.network, setup.rules)),
      truth_(setup.rules),
      interval_s_(setup.interval.value) {}

void SampleRecorder::on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    sensor_->observe(snapshot, roster, observation_);
    if (!observation_.is_report) return;
    if (observation_.time.value < next_s_) {
        pass();
        return;
    }
    build_scene();
    if (scene_.candidates.size() == 0) {
        pass();
        return;
    }
    truth_.look(snapshot);
    core::match_rows(scene_.tracks.key, snapshot.key, true_row_);
    record(snapshot);
    next_s_ = observation_.time.value + interval_s_;
}

std::uint8_t SampleRecorder::label(prediction::RowPair pair) const {
    return truth_.linked(true_row_[pair.left], true_row_[pair.right]) ? 1 : 0;
}

std::unique_ptr<SampleRecorder> make_sample_recorder(experiment::DatasetKind kind,
                                                     SampleRecorder::Setup setup) {
    switch (kind) {
        case experiment::DatasetKind::samples:
            return std::make_unique<GraphSampleRecorder>(std::move(setup));
        case experiment::DatasetKind::repair:
            return std::make_unique<RepairSampleRecorder>(std::move(setup));
        case experiment::DatasetKind::pair_samples:
            return std::make_unique<PairSampleRecorder>(std::move(setup));
        case experiment::DatasetKind::published:
        case experiment::DatasetKind::edge_times:
            break;
    }
    throw std::logic_error("this data set is not a file of samples");
}

const char* sample_ending(experiment::DatasetKind kind) {
    if (kind == experiment::DatasetKind::edge_times) return "-edge-times.csv";
    return kind == experiment::DatasetKind::pair_samples ? pair_sample_ending : graph_sample_extension;
}

PairDatasetRecorder::PairDatasetRecorder(const roads::Network& network, const graph::LinkRules& rules,
                                         const prediction::FeatureSchema& features,
                                         experiment::ListedPairs pairs)
    : network_(network), feature_count_(features.width), truth_(rules), listed_(rules) {
    if (pairs == experiment::ListedPairs::candidates) listed_.radius_m = prediction::candidate_reach_m(rules);
}

void PairDatasetRecorder::on_step(const truth::Snapshot& snapshot, const traffic::Roster& /*roster*/) {
    truth_.look(snapshot);
    if (truth_.link_count() <= most_links_) return;
    most_links_ = truth_.link_count();
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
    builder_.build({snapshot.x_m, snapshot.y_m, snapshot.vehicle_class}, listed_, near_);
    for (std::uint32_t row = 0; row < snapshot.size(); ++row) {
        for (const core::VehicleIndex other : near_.neighbours_of(row)) {
            if (other < row) continue;
            dataset_.source.push_back(row);
            dataset_.target.push_back(other);
            dataset_.label.push_back(truth_.linked(row, other) ? 1.0F : 0.0F);
        }
    }
}

}  // namespace clearway::samples
