#include "training/gradient_boosting.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/boosted_trees.hpp"
#include "prediction/repair_net.hpp"
#include "prediction/tree_inputs.hpp"
#include "training/detail/sample_parts.hpp"
#include "training/detail/xgboost.hpp"
#include "training/repair_batch.hpp"

namespace clearway::training {
namespace {

using prediction::tree_width;
using samples::RepairSample;
using samples::RepairSampleFile;

void check_radius(const std::vector<RepairSampleFile>& files) {
    for (const RepairSampleFile& file : files) {
        if (file.origin.link_radius_m == prediction::repair_link_radius_m) continue;
        throw core::InputError(
            {fmt::format("--data: {}, {}, replication {}", file.origin.scenario, file.origin.failure,
                         file.origin.replication),
             fmt::format("links below {} m", file.origin.link_radius_m),
             fmt::format("{} m, for which the trees are made", prediction::repair_link_radius_m),
             "Record with link_radius_m = 50"});
    }
}

/// The pairs of a part of the split, those that the rule is sure of thinned.
detail::BoostingData data_of(const std::vector<RepairSampleFile>& files, const std::vector<DataSeed>& seeds,
                             const BoostingConfig& config, const char* part) {
    std::vector<float> inputs, labels, weights;
    detail::LabelCounts counts;
    for (const RepairSampleFile& file : files) {
        if (!detail::is_of(file, seeds)) continue;
        // Keyed by the run as well, so that runs with equal times draw apart.
        const PairSampling sampling{
            config.easy_share,
            core::KeyedRandom(core::StudySeed{config.seed}, core::Replication{file.origin.replication})};
        for (const RepairSample& sample : file.samples) {
            counts.add(sample.linked);
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
    detail::require_both_classes(counts, part);
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

/// Scores of pairs by the trees and by the rule, with labels.
struct Scores {
    std::vector<float> logits;
    std::vector<double> rule;
    std::vector<std::uint8_t> linked;

    void append(const Scores& more) {
        logits.insert(logits.end(), more.logits.begin(), more.logits.end());
        rule.insert(rule.end(), more.rule.begin(), more.rule.end());
        linked.insert(linked.end(), more.linked.begin(), more.linked.end());
    }
};

Scores scores_of(const prediction::BoostedTrees& trees, const RepairSampleFile& file) {
    Scores scores;
    std::vector<float> row(tree_width);
    for (const RepairSample& sample : file.samples) {
        for (std::size_t at = 0; at < sample.linked.size(); ++at) {
            prediction::write_tree_inputs(sample.inputs, at, row);
            scores.logits.push_back(trees.sum(row));
        }
        scores.rule.insert(scores.rule.end(), sample.rule.begin(), sample.rule.end());
        scores.linked.insert(scores.linked.end(), sample.linked.begin(), sample.linked.end());
    }
    return scores;
}

BoostingGroup group_of(const std::string& scenario, const std::string& failure, const Scores& scores,
                       const BoostingResult& result) {
    return {scenario, failure,
            metrics::link_quality({probabilities(scores.logits), scores.linked}, result.threshold),
            metrics::link_quality({scores.rule, scores.linked}, result.rule_threshold)};
}

/// Chooses thresholds on the validation seeds and measures on the test seeds, by the program's own inference.
void measure(const std::vector<RepairSampleFile>& files, BoostingResult& result) {
    const prediction::BoostedTrees trees(result.weights, prediction::tree_schema());
    Scores validation, all;
    std::map<std::string, Scores> by_failure;
    std::map<std::pair<std::string, std::string>, Scores> by_both;
    for (const RepairSampleFile& file : files) {
        if (detail::is_of(file, result.seeds.validation)) validation.append(scores_of(trees, file));
        if (!detail::is_of(file, result.seeds.test)) continue;
        const Scores scores = scores_of(trees, file);
        all.append(scores);
        by_failure[file.origin.failure].append(scores);
        by_both[{file.origin.failure, file.origin.scenario}].append(scores);
    }
    result.threshold = metrics::best_f1_threshold({probabilities(validation.logits), validation.linked});
    result.rule_threshold = metrics::best_f1_threshold({validation.rule, validation.linked});
    result.groups.push_back(group_of("", "", all, result));
    for (const auto& [failure, scores] : by_failure)
        result.groups.push_back(group_of("", failure, scores, result));
    for (const auto& [both, scores] : by_both)
        result.groups.push_back(group_of(both.second, both.first, scores, result));
}

/// Throws core::InputError unless the test seeds have pairs of both kinds.
void check_test_part(const std::vector<RepairSampleFile>& files, const std::vector<DataSeed>& seeds) {
    detail::LabelCounts counts;
    for (const RepairSampleFile& file : files) {
        if (!detail::is_of(file, seeds)) continue;
        for (const RepairSample& sample : file.samples)
            counts.add(sample.linked);
    }
    detail::require_both_classes(counts, "test");
}

}  // namespace

BoostingResult train_gradient_boosting(const std::vector<RepairSampleFile>& files,
                                       const BoostingConfig& config, const TrainingHooks& hooks) {
    if (files.empty()) {
        throw core::InputError({"--data", "no samples", "",
                                "Record some with clearway dataset SCENARIO --samples --net graphsage"});
    }
    check_radius(files);
    BoostingResult result;
    result.seeds =
        detail::split_files(files, {config.split_seed, config.validation_share, config.test_share});
    check_test_part(files, result.seeds.test);
    const Parts parts{data_of(files, result.seeds.train, config, "training"),
                      data_of(files, result.seeds.validation, config, "validation")};
    result.train_pairs = parts.train.labels().size();
    detail::Booster booster(parts.train, parts.validation, parameters_of(config));
    grow(booster, parts, config, hooks, result);
    if (result.losses.empty()) return result;
    result.weights = weights_of(booster, result.best_tree + 1);
    if (result.outcome != Outcome::interrupted) measure(files, result);
    return result;
}

}  // namespace clearway::training
