#pragma once

#include <filesystem>
#include <memory>
#include <optional>
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

/// Records what a predictor was given at report rounds, with the true answers, for training and evaluation.
/// Watches through one sensor and takes one sample every `interval` of simulation time: at the first report
/// round after it that has a pair to predict.
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
    /// Writes the file atomically and returns what is in it: `12 samples`. Throws core::EnvironmentError.
    virtual std::string write(const std::filesystem::path& file) const = 0;

  protected:
    /// With `twins`, scenes have car-following twins, and candidates reach as it says.
    explicit SampleRecorder(Setup setup, std::optional<prediction::CandidateReach> twins = {});
    const roads::Network& network() const { return network_; }
    const graph::LinkRules& rules() const { return truth_.rules(); }
    const SampleOrigin& origin() const { return origin_; }
    const traffic::Observation& observation() const { return observation_; }
    /// Scene of the observation, valid after `build_scene`; always valid in `record`.
    const prediction::Scene& scene() const { return scene_; }
    void build_scene() { scenes_.build(observation_, scene_); }
    /// The label of a pair of rows of the scene's tracks: 1 when the two are truly linked. Only in `record`.
    std::uint8_t label(prediction::RowPair pair) const;

  private:
    /// Adds a sample of the scene, which has candidates.
    virtual void record(const truth::Snapshot& snapshot) = 0;
    /// Called at report rounds without a sample, for recorders that must see every round.
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

/// The recorder for a kind of samples; any kind but `published` and `edge_times`.
std::unique_ptr<SampleRecorder> make_sample_recorder(experiment::DatasetKind kind,
                                                     SampleRecorder::Setup setup);
/// Ending of the names of its files.
const char* sample_ending(experiment::DatasetKind kind);

/// Records the snapshot with the most links of the run, as chapter 5.4 of the dissertation stores it.
class PairDatasetRecorder : public trace::StepListener {
  public:
    PairDatasetRecorder(const roads::Network& network, const graph::LinkRules& rules,
                        const prediction::FeatureSchema& features, experiment::ListedPairs pairs);

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override;
    /// Empty when no two vehicles were ever linked.
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
