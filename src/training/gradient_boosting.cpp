#include "training/gradient_boosting.hpp"

#include <fmt/format.h>

#include "prediction/boosted_trees.hpp"
#include "prediction/tree_inputs.hpp"
#include "training/detail/sample_parts.hpp"
#include "training/detail/xgboost.hpp"
#include "training/repair_batch.hpp"

namespace clearway::training {
namespace {

using prediction::tree_width;
using samples::RepairSample;
using samples::RepairSampleFile;

/// The pairs of a part of the split, those that the rule is sure of thinned.
detail::BoostingData data_of(const std::vector<RepairSampleFile>& files, const std::vector<DataSeed>& seeds,
                             const BoostingConfig& config) {
    std::vector<float> inputs, labels, weights;
    for (const RepairSampleFile& file : files) {
        if (!detail::is_of(file, seeds)) continue;
        // Keyed by the run as well, so that runs with equal times draw apart.
        const PairSampling sampling{
            config.easy_share,
            core::KeyedRandom(core::StudySeed{config.seed}, core::Replication{file.origin.replication})};
        for (const RepairSample& sample : file.samples) {
            for (std::size_t at = 0; at < sample.linked.size(); ++at) {
                const float weight = weight_of(sample, at, sampling);
                if (weight == 0.0F) continue;
                inputs.resize(inputs.size() + tree_width);
                prediction::write_tree_inputs(sample.inputs, at, std::span(inputs).last(tree_width));
                labels.push_back(sample.linked[at]);
                weights.push_back(weight);
            }
        }
    }
    return {inputs, tree_width, labels, weights};
}

std::vector<detail::Booster::Parameter> parameters_of(const BoostingConfig& config) {
    return {{"max_depth", fmt::format("{}", config.max_depth)},
            {"learning_rate", fmt::format("{}", config.learning_rate)},
            {"min_child_weight", fmt::format("{}", config.min_child_weight)},
            {"subsample", fmt::format("{}", config.subsample)},
            {"colsample_bytree", fmt::format("{}", config.columns)},
            {"seed", fmt::format("{}", config.seed)}};
}

/// The pairs of two parts of the split.
struct Parts {
    detail::BoostingData train;
    detail::BoostingData validation;
};

/// Grows trees until the validation loss has not improved for `patience` of them.
void grow(detail::Booster& booster, const Parts& parts, const BoostingConfig& config,
          const TrainingHooks& hooks, BoostingResult& result) {
    for (std::uint32_t tree = 0; tree < config.trees; ++tree) {
        if (hooks.should_stop && hooks.should_stop()) {
            result.outcome = Outcome::interrupted;
            return;
        }
        booster.grow();
        result.losses.push_back({booster.loss(parts.train), booster.loss(parts.validation)});
        if (hooks.on_epoch) hooks.on_epoch(tree, result.losses.back());
        if (result.losses.back().held_out < result.losses[result.best_tree].held_out) {
            result.best_tree = tree;
        } else if (tree - result.best_tree >= config.patience) {
            result.outcome = Outcome::stopped_early;
            return;
        }
    }
}

prediction::Weights weights_of(const detail::Booster& booster, std::size_t trees) {
    prediction::Weights weights;
    weights.architecture = prediction::boosted_trees_architecture;
    weights.features = prediction::tree_schema();
    weights.inputs = prediction::tree_input_names();
    weights.tensors = booster.tensors(trees);
    return weights;
}

/// Measures by the program's own inference.
void measure_trees(const std::vector<RepairSampleFile>& files, BoostingResult& result) {
    const prediction::BoostedTrees trees(result.weights, prediction::tree_schema());
    std::vector<float> row(tree_width);
    const auto score = [&](const RepairSampleFile& file, RepairScores& scores) {
        for (const RepairSample& sample : file.samples) {
            for (std::size_t at = 0; at < sample.linked.size(); ++at) {
                prediction::write_tree_inputs(sample.inputs, at, row);
                scores.logits.push_back(trees.sum(row));
            }
        }
    };
    measure(files, score, result);
}

}  // namespace

BoostingResult train_gradient_boosting(const std::vector<RepairSampleFile>& files,
                                       const BoostingConfig& config, const TrainingHooks& hooks) {
    BoostingResult result;
    result.seeds = split_repair_files(files, {config.split_seed, config.validation_share, config.test_share},
                                      "the trees are");
    require_both_classes(samples_of(files, result.seeds.train), "training");
    require_both_classes(samples_of(files, result.seeds.validation), "validation");
    require_both_classes(samples_of(files, result.seeds.test), "test");
    const Parts parts{data_of(files, result.seeds.train, config),
                      data_of(files, result.seeds.validation, config)};
    result.train_pairs = parts.train.labels().size();
    detail::Booster booster(parts.train, parts.validation, parameters_of(config));
    grow(booster, parts, config, hooks, result);
    if (result.losses.empty()) return result;
    result.weights = weights_of(booster, result.best_tree + 1);
    if (result.outcome != Outcome::interrupted) measure_trees(files, result);
    return result;
}

}  // namespace clearway::training
