#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "training/output_folder.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

/// The summary of a training: identity, outcome, seeds, counts, losses, quality, and what the result says
/// beside. Numbers that are not defined are null. It is what `--json` prints and `summary.json` holds. `data`
/// is the folder that was read.
nlohmann::ordered_json summary_of(const TrainingResult& result, const Identity& identity,
                                  const std::filesystem::path& data);

/// Text of `losses.csv`: epoch (from 0) and both losses in nat; `held_out` names the second. Empty where not
/// finite.
std::string losses_csv(const std::vector<EpochLoss>& losses, const std::string& held_out);
/// Text of `metrics.csv`: a row for each group and predictor, `model` and `reference`. `groups` are not
/// empty.
std::string metrics_csv(const std::vector<GroupQuality>& groups, const std::string& model,
                        const std::string& reference);

/// Writes losses.csv and train_test_curve.svg where there are losses; summary.json; metrics.csv unless
/// nothing was measured; and, unless there is no model, MODE.weights with notes, MODE being the summary's
/// mode, and the file for `torch.load`. Each file whole or not at all. Throws core::EnvironmentError.
void write_outputs(const std::filesystem::path& folder, const TrainingResult& result,
                   const nlohmann::ordered_json& summary);

/// Hash over the content of files, for the summary. Throws core::InputError.
std::string hash_of_files(const std::vector<std::filesystem::path>& files);
/// Throws core::InputError naming files of one content, which would count twice. `hashes`: of their contents.
void require_distinct(const std::vector<std::filesystem::path>& files,
                      const std::vector<std::string>& hashes);

}  // namespace clearway::training
