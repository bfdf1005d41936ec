#pragma once

#include <filesystem>
#include <string>

#include "training/as_published.hpp"
#include "training/corrected.hpp"
#include "training/output_folder.hpp"

namespace clearway::training {

/// What a training was given, for its summary.
struct RunDescription {
    std::filesystem::path data;
    std::string data_hash;  ///< Over all files read.
    TrainingConfig training;
};

/// Identifies a training.
Identity identity_of(PairChoice pairs, const RunDescription& run);
Identity identity_of(const CorrectedConfig& config, const RunDescription& run);

/// The summary of a training: configuration, seeds, counts, final losses, quality. Numbers that are not
/// defined are null. It is what `--json` prints and `summary.json` holds.
nlohmann::ordered_json summary_of(const AsPublishedResult& result, PairChoice pairs,
                                  const RunDescription& run);
nlohmann::ordered_json summary_of(const CorrectedResult& result, const CorrectedConfig& config,
                                  const RunDescription& run);

/// Text of `losses.csv`: epoch (from 0) and both losses in nat; `held_out` names the second. Empty where not
/// finite.
std::string losses_csv(const std::vector<EpochLoss>& losses, const std::string& held_out);
/// Text of `predictions.csv`: every listed pair with its label, part of the split, logit and probability.
std::string predictions_csv(const AsPublishedResult& result);
/// Text of `metrics.csv`: a row for all test pairs and one for each scenario and failure.
std::string metrics_csv(const CorrectedResult& result);

/// Writes losses.csv, train_test_curve.svg and summary.json; `held_out` and `label` name the second loss.
void write_common(const std::filesystem::path& folder, const std::vector<EpochLoss>& losses,
                  const std::string& held_out, const std::string& label,
                  const nlohmann::ordered_json& summary);

/// Writes into `folder`: losses.csv, train_test_curve.svg, summary.json; and, unless no parameters are good,
/// GraphSAGENet.pth, predictions.csv (as published) or metrics.csv (corrected), and
/// graphsage_as_published.weights or graphsage_corrected.weights; with another convolution gcn.pth and
/// gcn.weights, or gat.pth and gat.weights. Each file whole or not at all. Throws core::EnvironmentError.
void write_outputs(const std::filesystem::path& folder, const AsPublishedResult& result,
                   const nlohmann::ordered_json& summary, const TrainingConfig& config);
void write_outputs(const std::filesystem::path& folder, const CorrectedResult& result,
                   const nlohmann::ordered_json& summary, const TrainingConfig& config,
                   const prediction::FeatureSchema& features);

/// Hash over the content of files, for the summary. Throws core::InputError.
std::string hash_of_files(const std::vector<std::filesystem::path>& files);

/// Throws core::InputError naming files of one content, which would count twice. `hashes`: of their contents.
void require_distinct(const std::vector<std::filesystem::path>& files,
                      const std::vector<std::string>& hashes);

}  // namespace clearway::training
