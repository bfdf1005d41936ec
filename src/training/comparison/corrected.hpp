#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "samples/graph_sample.hpp"
#include "training/comparison/net_training.hpp"

namespace clearway::training {

struct CorrectedConfig {
    TrainingConfig training;
    std::uint32_t batch_snapshots = 32;
    std::uint32_t patience = 10;
    double validation_share = 0.2;
    double test_share = 0.2;
    Convolution convolution = Convolution::sage;  ///< The net that is named says which.

    static constexpr void fields(const auto& table) {
        using C = CorrectedConfig;
        table(core::Field{"batch_snapshots", "1", &C::batch_snapshots, 1.0, 10000.0,
                          "Snapshots in one step of Adam", "assumed: a few thousand pairs a step"},
              core::Field{"patience", "1", &C::patience, 1.0, 100000.0,
                          "Epochs without a better validation loss before training stops", "assumed"},
              core::Field{"validation_share", "1", &C::validation_share, 0.01, 0.8,
                          "Share of the seeds that choose the epoch and the threshold", "assumed"},
              core::Field{"test_share", "1", &C::test_share, 0.01, 0.8,
                          "Share of the seeds that only measure", "assumed"});
    }
};

/// The reference is the dead-reckoned distance d alone, scored as radius / (radius + d): above 0.5 within the
/// link radius. Its order and its F1 mean something, log loss and calibration do not and are left out.
struct CorrectedResult : NetResult {
    CorrectedResult() {
        reference = "dead_reckoning";
        reference_threshold = 0.5;
    }
    nlohmann::ordered_json facts() const override;

    std::uint64_t train_snapshots = 0;
};

/// The published net trained on many snapshots as it should have been: messages along observed links only;
/// node numbers moved when snapshots are batched; positives and negatives from the candidate pairs of the
/// prediction task; split by seed; the epoch chosen by the log loss of validation seeds; measured on test
/// seeds. Candidates beyond `prediction::corrected_reach_m` count with probability 0, as in inference. Throws
/// core::InputError when the files do not share one feature schema, hold fewer than three seeds, or a part
/// lacks linked or unlinked pairs. Deterministic.
CorrectedResult train_corrected(const std::vector<samples::GraphSampleFile>& files,
                                const CorrectedConfig& config, const TrainingHooks& hooks = {});

/// Identifies a training.
Identity identity_of(const CorrectedConfig& config, const std::string& data_hash);

}  // namespace clearway::training
