#include "training/gradient_boosting.hpp"

#include <fmt/format.h>

#include "prediction/boosted_trees.hpp"
#include "prediction/tree_inputs.hpp"
#include "training/detail/figures.hpp"
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
        if (!is_of(file.origin, seeds)) continue;
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

/// Measures by the program's own inference.
void measure_trees(const std::vector<RepairSampleFile>& files, BoostingResult& result) {
    const prediction::BoostedTrees trees(result.weights(), prediction::tree_schema());
    std::vector<float> row(tree_width);
    const auto score = [&](const RepairSampleFile& file, Scores& scores) {
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

nlohmann::ordered_json BoostingResult::facts() const {
    return {{"trees_kept", losses.empty() ? detail::Json(nullptr) : detail::Json(best_round + 1)}};
}

prediction::Weights BoostingResult::weights() const {
    prediction::Weights weights;
    weights.architecture = prediction::boosted_trees_architecture;
    weights.features = prediction::tree_schema();
    weights.inputs = prediction::tree_input_names();
    weights.tensors = state;
    return weights;
}

Identity identity_of(const BoostingConfig& config, const std::string& data_hash) {
    return {{"mode", "gradient_boosting"},
            {"data_hash", data_hash},
            {"configuration", detail::json_from(config)}};
}

BoostingResult train_gradient_boosting(const std::vector<RepairSampleFile>& files,
                                       const BoostingConfig& config, const TrainingHooks& hooks) {
    BoostingResult result;
    result.seeds = split_repair_files(files, {config.split_seed, config.validation_share, config.test_share},
                                      "the trees are");
    result.link_radius = link_radii(origins_of(files));
    const detail::BoostingData train = data_of(files, result.seeds.train, config);
    const detail::BoostingData validation = data_of(files, result.seeds.validation, config);
    result.train_pairs = train.labels().size();
    detail::Booster booster(train, validation, parameters_of(config));
    const auto grow = [&](std::uint32_t) {
        booster.grow();
        return EpochLoss{booster.loss(train), booster.loss(validation)};
    };
    run_rounds(
        {config.trees, config.patience}, hooks, grow, [](bool) {}, result);
    if (result.losses.empty()) return result;
    result.state = booster.tensors(result.best_round + 1);
    if (result.outcome != Outcome::interrupted) measure_trees(files, result);
    return result;
}

}  // namespace clearway::training
