#pragma once

#include <filesystem>
#include <string>

#include "training/output_folder.hpp"
#include "training/repair.hpp"

namespace clearway::training {

/// A trained net as a model file for prediction::RepairNet. `state` is one of a whole net
/// (RepairConfig::is_whole).
prediction::Weights repair_weights(const StateDict& state, const prediction::RepairDimensions& dimensions);

/// Identifies a training.
Identity identity_of(const RepairConfig& config, const std::string& data_hash);

/// What `--json` prints and `summary.json` holds: configuration, seeds, counts, losses, quality. Numbers that
/// are not defined are null.
nlohmann::ordered_json summary_of(const RepairResult& result, const RepairConfig& config,
                                  const std::filesystem::path& data, const std::string& data_hash);

/// "test" of a summary; `model` is the name of the model's entry.
nlohmann::ordered_json test_summary(const std::vector<RepairGroup>& groups, const char* model);

/// Text of `metrics.csv`: rows for all test pairs, each failure, and each scenario and failure. `groups` are
/// not empty.
std::string metrics_csv(const std::vector<RepairGroup>& groups, const std::string& predictor);

/// Writes losses.csv, train_test_curve.svg, summary.json, metrics.csv unless nothing was measured, and,
/// unless `weights` are empty, these with notes, named after the summary's mode. `round` is what an epoch is
/// called. Each file whole or not at all. Throws core::EnvironmentError.
void write_outputs(const std::filesystem::path& folder, const RepairTraining& result,
                   const nlohmann::ordered_json& summary, const char* round, prediction::Weights weights);

/// The same with the weights of a whole net, unless no parameters are good.
void write_outputs(const std::filesystem::path& folder, const RepairResult& result,
                   const RepairConfig& config, const nlohmann::ordered_json& summary);

}  // namespace clearway::training
