#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "experiment/dataset_job.hpp"
#include "graph/proximity.hpp"
#include "metrics/true_links.hpp"
#include "prediction/candidates.hpp"
#include "samples/dataset_files.hpp"
#include "samples/sample_origin.hpp"
#include "sensing/sensor.hpp"
#include "trace/step_listener.hpp"

namespace clearway::samples {

/// Records what a predictor was given at report rounds, with the true answer beside it: data to train and to
/// judge with. Watches through one sensor, and takes one sample every `interval` of simulation time, at the
/// first report round then at which there is a pair to predict.
class SampleRecorder : public trace::StepListener {
  public:
    struct Setup {
        const roads::Network& network;  ///< Outlives the recorder.
        graph::LinkRules rules;
        SampleOrigin origin;  ///< Its features are filled in.
        std::unique_ptr<sensing::SensorModel> sensor;
        core::Seconds interval;
    };

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) final;
    /// Writes the file whole or not at all, and says what is in it: `12 samples`. Throws
    /// core::EnvironmentError.
    virtual std::string write(const std::filesystem::path& file) const = 0;

  protected:
    explicit SampleRecorder(Setup setup);
    const roads::Network& network() const { return network_; }
    const graph::LinkRules& rules() const { return truth_.rules(); }
    const SampleOrigin& origin() const { return origin_; }
    const traffic::Observation& observation() const { return observation_; }
    /// Of the observation, once `build_scene` was called; in `record` it was.
    const prediction::Scene& scene() const { return scene_; }
    void build_scene() { scenes_.build(observation_, scene_); }
    /// The label of a pair of rows of the scene's tracks: 1 when the two are truly linked. In `record` alone.
    std::uint8_t label(prediction::RowPair pair) const;

  private:
    /// Adds a sample of the scene, which has candidates.
    virtual void record(const truth::Snapshot& snapshot) = 0;
    /// A report round at which no sample is taken: for recorders that must see them all.
    virtual void pass() {}

    const roads::Network& network_;
    SampleOrigin origin_;
    std::unique_ptr<sensing::SensorModel> sensor_;
    traffic::Observation observation_;
    prediction::SceneBuilder scenes_;
    prediction::Scene scene_;
    metrics::TrueLinks truth_;
    std::vector<core::VehicleIndex> true_row_;  ///< By row of the tracks.
    double interval_s_;
    double next_s_ = 0.0;
};

/// The recorder of a kind of samples: any kind but `published`.
std::unique_ptr<SampleRecorder> make_sample_recorder(experiment::DatasetKind kind,
                                                     SampleRecorder::Setup setup);
/// How the names of its files end.
const char* sample_ending(experiment::DatasetKind kind);

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
    std::uint32_t feature_count_;
    metrics::TrueLinks truth_;
    graph::LinkRules listed_;  ///< Which pairs the list names.
    graph::ProximityBuilder builder_;
    graph::ProximityGraph near_;
    std::size_t most_links_ = 0;
    PairDataset dataset_;
    core::Seconds time_;
};

}  // namespace clearway::samples
