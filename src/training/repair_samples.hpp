#pragma once

#include <vector>

#include "samples/repair_sample.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

// What the trainings on the samples of the improved net share.

using RepairSamples = std::vector<const samples::RepairSample*>;

/// Splits the files by seed. `model` is what is trained, for messages. Throws core::InputError without files,
/// for links of another radius than models are made for, when a part of the split lacks linked or unlinked
/// pairs, and as split_seeds does.
SeedSplit split_repair_files(const std::vector<samples::RepairSampleFile>& files, const SplitShares& shares,
                             const char* model);
/// The samples of some seeds.
RepairSamples samples_of(const std::vector<samples::RepairSampleFile>& files,
                         const std::vector<DataSeed>& seeds);

/// Writes the logits of a file's pairs, in order, and the errors of displacements.
using ScoreFile = std::function<void(const samples::RepairSampleFile& file, Scores& scores)>;
/// Measures a model on the test seeds, beside the route rule.
void measure(const std::vector<samples::RepairSampleFile>& files, const ScoreFile& score,
             TrainingResult& result);

}  // namespace clearway::training
