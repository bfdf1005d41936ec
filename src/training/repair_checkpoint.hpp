#pragma once

#include "training/repair.hpp"

namespace clearway::training {

/// How far a training has come.
struct RepairProgress {
    std::vector<EpochLoss> losses;
    std::uint32_t best_epoch = 0;
    bool stopped_early = false;
    StateDict net;        ///< After the last epoch.
    StateDict best;       ///< After the best one.
    StateDict optimizer;  ///< Adam's moments after the last epoch.
};

/// A process killed while writing leaves this checkpoint or the previous one. Does nothing without a folder.
/// Throws core::EnvironmentError.
void write_checkpoint(const Checkpoint& checkpoint, const RepairConfig& config,
                      const RepairProgress& progress);
/// False, and nothing read, when there is none. Throws core::InputError when it is damaged, or belongs to
/// another configuration or data set (naming the differences).
bool read_checkpoint(const Checkpoint& checkpoint, const RepairConfig& config, RepairProgress& progress);

}  // namespace clearway::training
