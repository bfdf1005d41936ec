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

/// Text of `metrics.csv`: rows for all test pairs, each failure, and each scenario and failure.
std::string metrics_csv(const RepairResult& result);

/// Writes losses.csv, train_test_curve.svg, summary.json, and, unless no parameters are good, (of a whole
/// net) graphsage.weights and, unless interrupted before the measuring, metrics.csv. Each file whole or not
/// at all. Throws core::EnvironmentError.
void write_outputs(const std::filesystem::path& folder, const RepairResult& result,
                   const RepairConfig& config, const nlohmann::ordered_json& summary);

}  // namespace clearway::training
