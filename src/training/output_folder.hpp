#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "training/trainer.hpp"

namespace clearway::training {

/// Identifies a training: `mode`, `data_hash` and `configuration` as in its summary. Trainings with the same
/// identity write the same files.
using Identity = nlohmann::ordered_json;

/// Says which training a checkpoint belongs to; its tensors are beside it, in `checkpoint.pth`.
inline constexpr const char* checkpoint_file = "checkpoint.json";
/// What to do about a damaged checkpoint.
inline constexpr const char* cure_anew = "Remove checkpoint.json and checkpoint.pth to start anew";

/// Throws core::InputError naming what differs when `found`, the content of `file`, is of another training
/// than `wanted`.
void require_same_training(const nlohmann::ordered_json& found, const Identity& wanted,
                           const std::filesystem::path& file);

/// The folder that a training writes its results into. It holds the results of one training; those of another
/// are never overwritten or mixed in.
class OutputFolder {
  public:
    /// Creates the folder and removes half-written files of killed writers. Throws core::EnvironmentError,
    /// and core::InputError when results or a checkpoint of another training are there, or something else.
    OutputFolder(std::filesystem::path folder, const Identity& identity);

    const std::filesystem::path& path() const { return folder_; }
    /// Whether to keep what is in the folder: this training was interrupted, and it either finished no epoch
    /// or is already there whole from an earlier call.
    bool keeps_earlier(Outcome outcome, std::size_t epochs) const;
    /// Whether a whole training is there from an earlier call.
    bool is_whole() const { return whole_; }

  private:
    std::filesystem::path folder_;
    bool whole_ = false;
};

}  // namespace clearway::training
