#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "metrics/link_quality.hpp"
#include "samples/graph_sample.hpp"
#include "training/seeds.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

struct CorrectedConfig {
    TrainingConfig training;
    std::uint32_t batch_snapshots = 32;
    std::uint32_t patience = 10;
    double validation_share = 0.2;
    double test_share = 0.2;
    Convolution convolution = Convolution::sage;

    static constexpr auto fields() {
        using C = CorrectedConfig;
        return std::make_tuple(
            core::Field{"batch_snapshots", "1", &C::batch_snapshots, 1.0, 10000.0,
                        "Snapshots in one step of Adam", "assumed: a few thousand pairs a step"},
            core::Field{"patience", "1", &C::patience, 1.0, 100000.0,
                        "Epochs without a better validation loss before training stops", "assumed"},
            core::Field{"validation_share", "1", &C::validation_share, 0.01, 0.8,
                        "Share of the seeds that choose the epoch and the threshold", "assumed"},
            core::Field{"test_share", "1", &C::test_share, 0.01, 0.8, "Share of the seeds that only measure",
                        "assumed"},
            core::Field{"convolution", "", &C::convolution, 0, 0,
                        "Convolution of both layers: GraphSAGE's, or that of the predictor gcn or gat",
                        "the dissertation's is sage"});
    }
};

/// Quality on the test seeds, for all pairs or for those of one scenario and failure.
struct GroupQuality {
    std::string scenario;  ///< Empty: all.
    std::string failure;   ///< Empty: all.
    metrics::LinkQuality net;
    /// The same pairs scored by the dead-reckoned distance d alone, as radius / (radius + d): above 0.5
    /// within the link radius. Its order and its F1 mean something, its log loss and calibration do not.
    metrics::LinkQuality dead_reckoning;
};

struct CorrectedResult {
    Outcome outcome = Outcome::finished;
    Convolution convolution = Convolution::sage;
    std::vector<EpochLoss> losses;  ///< Held out: the validation seeds.
    std::uint32_t best_epoch = 0;
    StateDict state;  ///< Of the best epoch; none when no epoch had finite losses.
    SeedSplit seeds;
    std::uint64_t train_snapshots = 0;
    std::uint64_t train_pairs = 0;
    double threshold = 0.5;            ///< Greatest F1 on the validation seeds.
    double link_radius_m = 50.0;       ///< Of the data.
    std::vector<GroupQuality> groups;  ///< On the test seeds: all first, then by scenario and failure.
};

/// The published net trained on many snapshots as it should have been: messages along observed links only;
/// node numbers moved when snapshots are batched; positives and negatives from the candidate pairs of the
/// prediction task; split by seed; the epoch chosen by the log loss of validation seeds; measured on test
/// seeds. Candidates beyond `prediction::corrected_reach_m` count with probability 0, as in inference. Throws
/// core::InputError when the files do not share one feature schema, hold fewer than three seeds, or a part
/// lacks linked or unlinked pairs. Deterministic.
CorrectedResult train_corrected(const std::vector<samples::GraphSampleFile>& files,
                                const CorrectedConfig& config, const TrainingHooks& hooks = {});

}  // namespace clearway::training
