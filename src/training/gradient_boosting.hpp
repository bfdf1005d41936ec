#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "prediction/weights.hpp"
#include "samples/repair_sample.hpp"
#include "training/output_folder.hpp"
#include "training/repair_samples.hpp"

namespace clearway::training {

/// How the trees are grown. Names of settings are XGBoost's where it has them.
struct BoostingConfig {
    std::uint32_t trees = 600;
    std::uint32_t max_depth = 8;
    double learning_rate = 0.15;
    double min_child_weight = 20.0;
    double subsample = 0.7;
    double columns = 0.5;
    std::uint32_t patience = 20;
    std::uint64_t seed = 1;
    std::uint64_t split_seed = 1;
    double validation_share = 0.2;
    double test_share = 0.2;
    double easy_share = 0.1;

    static constexpr void fields(const auto& table) {
        using C = BoostingConfig;
        using core::Field;
        table(
            Field{"trees", "1", &C::trees, 1.0, 10000.0, "Trees at most",
                  "250 were worse on validation seeds"},
            Field{"max_depth", "1", &C::max_depth, 1.0, 16.0, "Depth of a tree",
                  "6 was worse on validation seeds"},
            Field{"learning_rate", "1", &C::learning_rate, 1e-4, 1.0, "Share of each tree that counts",
                  "assumed"},
            Field{"min_child_weight", "1", &C::min_child_weight, 0.0, 1e9, "Least sum of p (1 - p) in a leaf",
                  "assumed: leaves of a few pairs learn noise"},
            Field{"subsample", "1", &C::subsample, 0.01, 1.0, "Share of the pairs that each tree sees",
                  "assumed"},
            Field{"columns", "1", &C::columns, 0.01, 1.0, "Share of the inputs that each tree sees",
                  "assumed"},
            Field{"patience", "1", &C::patience, 1.0, 10000.0,
                  "Trees without a better validation loss before training stops", "assumed"},
            Field{"seed", "1", &C::seed, 0.0, 2e9, "Seed of every draw", "assumed"},
            Field{"split_seed", "1", &C::split_seed, 0.0, 9e15,
                  "Seed of the draw that deals the data's seeds", "as graphsage"},
            Field{"validation_share", "1", &C::validation_share, 0.01, 0.8,
                  "Share of the data's seeds that choose the number of trees and the threshold",
                  "as graphsage"},
            Field{"test_share", "1", &C::test_share, 0.01, 0.8, "Share of the data's seeds that only measure",
                  "as graphsage"},
            Field{"easy_share", "1", &C::easy_share, 0.001, 1.0,
                  "Share kept of the pairs about which the route rule is certain, weighted to represent all "
                  "of them",
                  "assumed: memory"});
    }
};

/// `state` are the tensors of prediction::BoostedTrees, `best_round` the last tree that is kept, from 0.
struct BoostingResult : TrainingResult {
    BoostingResult() {
        round = "tree";
        reference = "route_rule";
    }
    nlohmann::ordered_json facts() const override;
    prediction::Weights weights() const override;
};

/// Grows trees by XGBoost (Chen and Guestrin 2016) on the samples of the improved net, with its split by
/// seed. Deterministic: one thread. Throws core::InputError for fewer than three seeds, a part of the split
/// with pairs of only one class, or another link radius than the trees are made for.
BoostingResult train_gradient_boosting(const std::vector<samples::RepairSampleFile>& files,
                                       const BoostingConfig& config, const TrainingHooks& hooks = {});

/// Identifies a training.
Identity identity_of(const BoostingConfig& config, const std::string& data_hash);

}  // namespace clearway::training
