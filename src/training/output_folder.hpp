#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "training/trainer.hpp"

namespace clearway::training {

/// What makes a training the one that it is: `mode`, `data_hash` and `configuration` as its summary has them.
/// Trainings of one identity leave the same files.
using Identity = nlohmann::ordered_json;

/// Says which training a checkpoint belongs to; its tensors are beside it, in `checkpoint.pth`.
inline constexpr const char* checkpoint_file = "checkpoint.json";
/// What to do about a damaged checkpoint.
inline constexpr const char* cure_anew = "Remove checkpoint.json and checkpoint.pth to start anew";

/// Throws core::InputError naming what differs when `found`, the content of `file`, is of another training
/// than `wanted`.
void require_same_training(const nlohmann::ordered_json& found, const Identity& wanted,
                           const std::filesystem::path& file);

/// The folder that a training writes its results into. It holds the results of one training: those of
/// another are neither overwritten nor mixed with.
class OutputFolder {
  public:
    /// Makes the folder and removes what writers that were killed left half written. Throws
    /// core::EnvironmentError, and core::InputError when results or a checkpoint of another training are
    /// there.
    OutputFolder(std::filesystem::path folder, const Identity& identity);

    const std::filesystem::path& path() const { return folder_; }
    /// Whether what is there is worth more than what a training came to: it was interrupted before its first
    /// epoch, or is there whole from an earlier call.
    bool keeps_earlier(Outcome outcome, std::size_t epochs) const;
    /// Whether a whole training is there from an earlier call.
    bool is_whole() const { return whole_; }

  private:
    std::filesystem::path folder_;
    bool whole_ = false;
};

}  // namespace clearway::training
