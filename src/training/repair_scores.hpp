#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "metrics/link_quality.hpp"
#include "samples/repair_sample.hpp"
#include "training/seeds.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

// What the trainings on the samples of the improved net share: the split, the scores and the measuring.

using RepairSamples = std::vector<const samples::RepairSample*>;

/// Quality on the test seeds: for all pairs, or those of a failure, or of a scenario and a failure.
struct RepairGroup {
    std::string scenario;  ///< Empty: all.
    std::string failure;   ///< Empty: all.
    metrics::LinkQuality model;
    metrics::LinkQuality rule;  ///< The samples' route rule on the same pairs.
    /// Mean absolute error of displacements, m; 0 without any. None of a model that moves no vehicle.
    std::optional<double> displacement_error_m;
    std::optional<double> rule_displacement_error_m;
};

/// What every such training gives.
struct RepairTraining {
    Outcome outcome = Outcome::finished;
    std::vector<EpochLoss> losses;  ///< Of the links, one per epoch or tree; held out: the validation seeds.
    SeedSplit seeds;
    std::uint64_t train_pairs = 0;
    double threshold = 0.5;  ///< Of greatest F1 on the validation seeds.
    double rule_threshold = 0.5;
    prediction::RadiusRange link_radius;  ///< Of all the data.
    std::vector<RepairGroup> groups;      ///< On the test seeds: all, by failure, by scenario and failure.
};

/// Sums of absolute errors of displacements.
struct DisplacementErrors {
    double model_m = 0.0;
    double rule_m = 0.0;
    std::size_t count = 0;
};

/// Scores of pairs by a model and by the rule, with labels.
struct RepairScores {
    std::vector<float> logits;
    std::vector<double> rule;  ///< As the samples have it: without start at green.
    std::vector<std::uint8_t> linked;
    std::optional<DisplacementErrors> displacements;  ///< None of a model that moves no vehicle.

    void append(const RepairScores& more);
};

/// Splits the files by seed. `model` is what is trained, for messages. Throws core::InputError without files,
/// for links of another radius than models are made for, and as split_seeds does.
SeedSplit split_repair_files(const std::vector<samples::RepairSampleFile>& files, const SplitShares& shares,
                             const char* model);

/// The samples of some seeds.
RepairSamples samples_of(const std::vector<samples::RepairSampleFile>& files,
                         const std::vector<DataSeed>& seeds);

/// Throws core::InputError unless the samples, those of `part` of the split, have pairs of both kinds.
void require_both_classes(const RepairSamples& samples, const char* part);

/// Scores a file by a model: sets the logits of its pairs, in order, and the errors of displacements.
using ScoreFile = std::function<void(const samples::RepairSampleFile& file, RepairScores& scores)>;

/// Chooses thresholds on the validation seeds and measures on the test seeds.
void measure(const std::vector<samples::RepairSampleFile>& files, const ScoreFile& score,
             RepairTraining& result);

}  // namespace clearway::training
