#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "experiment/dataset_job.hpp"
#include "graph/proximity.hpp"
#include "prediction/candidates.hpp"
#include "prediction/features.hpp"
#include "prediction/predictor.hpp"
#include "prediction/repair_inputs.hpp"
#include "samples/dataset_files.hpp"
#include "samples/graph_sample.hpp"
#include "samples/pair_samples.hpp"
#include "samples/repair_sample.hpp"
#include "sensing/sensor.hpp"
#include "trace/step_listener.hpp"

namespace clearway::samples {

/// Records what a predictor was given at report rounds, with the true answer beside it: data to train and to
/// judge with.
class SampleRecorder : public trace::StepListener {
  public:
    /// Watches through `sensor`. One sample every `interval` of simulation time, at the first report round
    /// then. `network` outlives the recorder.
    SampleRecorder(const roads::Network& network, const graph::LinkRules& rules,
                   const GraphSampleOrigin& origin, std::unique_ptr<sensing::SensorModel> sensor,
                   core::Seconds interval);

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override;
    const GraphSampleWriter& writer() const { return writer_; }

  private:
    GraphSample sample_of(const truth::Snapshot& snapshot) const;

    graph::LinkRules rules_;
    std::unique_ptr<sensing::SensorModel> sensor_;
    traffic::Observation observation_;
    prediction::SceneBuilder scenes_;
    prediction::Scene scene_;
    prediction::ObservedMessages messages_;
    prediction::MessageGraph observed_;
    std::vector<float> features_;
    GraphSampleWriter writer_;
    double interval_s_;
    double next_s_ = 0.0;
};

/// Records what the improved net is given, with the true links and displacements, and what the route rule
/// says of the same pairs.
class RepairSampleRecorder : public trace::StepListener {
  public:
    /// As SampleRecorder.
    RepairSampleRecorder(const roads::Network& network, const graph::LinkRules& rules,
                         const GraphSampleOrigin& origin, std::unique_ptr<sensing::SensorModel> sensor,
                         core::Seconds interval);

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override;
    const RepairSampleWriter& writer() const { return writer_; }

  private:
    void label(const truth::Snapshot& snapshot);

    const roads::Network& network_;
    graph::LinkRules rules_;
    std::unique_ptr<sensing::SensorModel> sensor_;
    traffic::Observation observation_;
    prediction::SceneBuilder scenes_;
    prediction::Scene scene_;
    prediction::RepairInputBuilder inputs_;
    std::unique_ptr<prediction::Predictor> rule_;
    traffic::BelievedGraph belief_;
    RepairSample sample_;
    RepairSampleWriter writer_;
    double interval_s_;
    double next_s_ = 0.0;
};

/// Records the features of every candidate pair at report rounds (prediction/pair_features.hpp), with the
/// true answer: data for the logistic pair model.
class PairSampleRecorder : public trace::StepListener {
  public:
    /// As SampleRecorder.
    PairSampleRecorder(const roads::Network& network, const graph::LinkRules& rules,
                       const PairSampleOrigin& origin, std::unique_ptr<sensing::SensorModel> sensor,
                       core::Seconds interval);

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override;
    const PairSampleFile& samples() const { return samples_; }

  private:
    graph::LinkRules rules_;
    std::unique_ptr<sensing::SensorModel> sensor_;
    traffic::Observation observation_;
    prediction::SceneBuilder scenes_;
    prediction::Scene scene_;
    PairSampleFile samples_;
    double interval_s_;
    double next_s_ = 0.0;
};

/// Records one snapshot as chapter 5.4 of the dissertation stores it: the one with the most links of the run.
class PairDatasetRecorder : public trace::StepListener {
  public:
    PairDatasetRecorder(const roads::Network& network, const graph::LinkRules& rules,
                        const prediction::FeatureSchema& features, experiment::ListedPairs pairs);

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override;
    /// Empty when no two vehicles ever met.
    const PairDataset& dataset() const { return dataset_; }
    core::Seconds time() const { return time_; }

  private:
    void take(const truth::Snapshot& snapshot);

    const roads::Network& network_;
    graph::LinkRules rules_;
    std::uint32_t feature_count_;
    experiment::ListedPairs pairs_;
    graph::ProximityBuilder builder_;
    graph::ProximityGraph links_;
    graph::ProximityGraph near_;
    std::size_t most_links_ = 0;
    PairDataset dataset_;
    core::Seconds time_;
};

}  // namespace clearway::samples
