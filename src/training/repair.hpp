#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "core/spellings.hpp"
#include "samples/repair_sample.hpp"
#include "training/output_folder.hpp"
#include "training/repair_samples.hpp"
#include "training/torch_repair_net.hpp"

namespace clearway::training {

/// How the improved net is trained. Settings marked as ablation make a net that the program cannot run.
struct RepairConfig {
    std::uint32_t epochs = 30;
    double learning_rate = 0.003;
    std::uint32_t batch_snapshots = 16;
    std::uint32_t patience = 8;
    std::uint64_t seed = 1;
    std::uint64_t split_seed = 1;
    double validation_share = 0.2;
    double test_share = 0.2;
    double easy_share = 0.25;
    double motion_weight = 0.2;
    std::uint32_t layers = 2;
    std::uint32_t hidden = 32;
    Aggregation aggregation = Aggregation::gated;
    MessageEdges edges = MessageEdges::believed;
    bool motion_head = true;
    bool pair_features = true;
    std::uint32_t most_snapshots = 0;

    static constexpr void fields(const auto& table) {
        using C = RepairConfig;
        using core::Field;
        table(
            Field{"epochs", "1", &C::epochs, 1.0, 100000.0, "Passes over the training snapshots, at most",
                  "chosen on validation seeds"},
            Field{"learning_rate", "1", &C::learning_rate, 1e-9, 1e30,
                  "Step size of Adam at first; it falls to 0 along a cosine", "chosen on validation seeds"},
            Field{"batch_snapshots", "1", &C::batch_snapshots, 1.0, 10000.0, "Snapshots in one step of Adam",
                  "assumed"},
            Field{"patience", "1", &C::patience, 1.0, 100000.0,
                  "Epochs without a better validation loss before training stops", "assumed"},
            Field{"seed", "1", &C::seed, 0.0, 9e15, "Seed of the initial parameters and of every draw",
                  "assumed"},
            Field{"split_seed", "1", &C::split_seed, 0.0, 9e15,
                  "Seed of the draw that deals the data's seeds", "assumed"},
            Field{"validation_share", "1", &C::validation_share, 0.01, 0.8,
                  "Share of the data's seeds that choose the epoch and the threshold", "assumed"},
            Field{"test_share", "1", &C::test_share, 0.01, 0.8, "Share of the data's seeds that only measure",
                  "assumed"},
            Field{"easy_share", "1", &C::easy_share, 0.001, 1.0,
                  "Share kept of the pairs about which the route rule is certain, weighted to represent all "
                  "of them",
                  "docs/models/graphsage.md"},
            Field{"motion_weight", "1", &C::motion_weight, 0.0, 100.0,
                  "Weight of the motion loss beside the link loss", "assumed"},
            Field{"layers", "1", &C::layers, 0.0, 4.0, "Rounds of messages; 0: none (ablation)", "assumed"},
            Field{"hidden", "1", &C::hidden, 8.0, 512.0, "Width of a vehicle's row", "assumed"},
            Field{"aggregation", "", &C::aggregation, 0, 0, "How messages are gathered (others: ablation)",
                  "docs/models/graphsage.md"},
            Field{"edges", "", &C::edges, 0, 0, "Edges that carry messages (observed: ablation)",
                  "docs/models/graphsage.md"},
            Field{"motion_head", "", &C::motion_head, 0, 0, "Whether vehicles are moved (false: ablation)",
                  "docs/models/graphsage.md"},
            Field{"pair_features", "", &C::pair_features, 0, 0,
                  "Whether the decoder sees distances and ages (false: embeddings alone, ablation)",
                  "docs/models/graphsage.md"},
            Field{"most_snapshots", "1", &C::most_snapshots, 0.0, 1e9,
                  "Training snapshots used, spread over all; 0: every one (others: ablation)", "all"});
    }

    RepairNetConfig net() const;
    /// Whether the program can run the net.
    bool is_whole() const;
};
constexpr core::Spellings<MessageEdges, 2> spellings(MessageEdges) {
    return {{{MessageEdges::believed, "believed"}, {MessageEdges::observed, "observed"}}};
}

struct RepairResult : TrainingResult {
    RepairResult() { reference = "route_rule"; }
    nlohmann::ordered_json facts() const override;
    prediction::Weights weights() const override;

    RepairConfig config;
    std::uint64_t train_snapshots = 0;
    std::size_t parameter_count = 0;
};

/// Where a training keeps what it needs to go on after an interruption.
struct Checkpoint {
    std::filesystem::path folder;  ///< Empty: none is kept. Files `checkpoint.pth` and `checkpoint.json`.
    std::string data_hash;         ///< Of the data set; a checkpoint of another one is refused.
};

/// Trains the improved net on a mixture of failures, scenarios and seeds. The parts of the split hold
/// different seeds of the data; the epoch with the least log loss on validation seeds wins; measured on test
/// seeds. After every epoch the checkpoint is renewed; a training that finds one of the same configuration
/// and data goes on from it and gives the same net as one that was never interrupted. Deterministic. Throws
/// core::InputError: fewer than three seeds; a part without pairs, or with labels of one class only; or a
/// checkpoint of another configuration or data set (naming the difference).
RepairResult train_repair(const std::vector<samples::RepairSampleFile>& files, const RepairConfig& config,
                          const Checkpoint& checkpoint, const TrainingHooks& hooks = {});

/// A net as a model file for prediction::RepairNet. `state` is one of a whole net (RepairConfig::is_whole).
prediction::Weights repair_weights(const StateDict& state, const prediction::RepairDimensions& dimensions);
/// Identifies a training.
Identity identity_of(const RepairConfig& config, const std::string& data_hash);

}  // namespace clearway::training
