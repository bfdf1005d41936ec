#include "training/gradient_boosting.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "prediction/boosted_trees.hpp"
#include "prediction/predictor.hpp"
#include "prediction/tree_inputs.hpp"
#include "support/message_of.hpp"
#include "support/temporary_folder.hpp"
#include "synthetic_repair.hpp"
#include "training/detail/xgboost.hpp"
#include "training/outputs.hpp"

namespace clearway::training {
namespace {

using samples::RepairSampleFile;
using support::message_of;
using ::testing::HasSubstr;

BoostingConfig few_trees() {
    BoostingConfig config;
    config.trees = 40;
    config.max_depth = 4;
    return config;
}

TEST(TrainGradientBoosting, BeatsTheRuleWhereThereIsSomethingToLearn) {
    const BoostingResult result = train_gradient_boosting(runs(10, 30), few_trees());
    ASSERT_FALSE(result.groups.empty());
    EXPECT_GT(result.groups.front().model.ap.value(), result.groups.front().reference->ap.value() + 0.005);
    EXPECT_LT(result.losses.back().train, 0.5 * result.losses.front().train);
    EXPECT_EQ(result.groups.size(), 1u + 2u + 2u) << "all, by failure, by scenario and failure";
    EXPECT_EQ(result.seeds.train.size(), 6u);
}

TEST(TrainGradientBoosting, KeepsTheTreesUntilTheBest) {
    BoostingConfig config = few_trees();
    config.trees = 300;
    config.patience = 5;
    config.min_child_weight = 0.0;
    config.max_depth = 8;
    const BoostingResult result = train_gradient_boosting(runs(6, 6), config);
    ASSERT_EQ(result.outcome, Outcome::stopped_early);
    EXPECT_EQ(result.losses.size(), result.best_round + 1 + config.patience);
    const prediction::BoostedTrees trees(result.weights(), prediction::tree_schema());
    EXPECT_EQ(trees.tree_count(), result.best_round + 1);
    for (const EpochLoss& loss : result.losses)
        EXPECT_GE(loss.held_out, result.losses[result.best_round].held_out);
}

TEST(TrainGradientBoosting, GivesTheSameTreesAgain) {
    const std::vector<RepairSampleFile> files = runs(6);
    const BoostingResult one = train_gradient_boosting(files, few_trees());
    const BoostingResult again = train_gradient_boosting(files, few_trees());
    EXPECT_EQ(prediction::format_weights(one.weights()), prediction::format_weights(again.weights()));
    BoostingConfig other = few_trees();
    other.seed = 2;
    EXPECT_NE(prediction::format_weights(train_gradient_boosting(files, other).weights()),
              prediction::format_weights(one.weights()));
}

/// The program's own inference against XGBoost's.
TEST(TrainGradientBoosting, InferenceAgreesWithXgboost) {
    SyntheticRepair world(9);
    std::vector<float> inputs, labels;
    for (int second = 0; second < 20; ++second) {
        const samples::RepairSample sample = world.sample(second);
        for (std::size_t at = 0; at < sample.linked.size(); ++at) {
            inputs.resize(inputs.size() + prediction::tree_width);
            prediction::write_tree_inputs(sample.inputs, at, std::span(inputs).last(prediction::tree_width));
            labels.push_back(sample.linked[at]);
        }
    }
    const detail::BoostingData data(inputs, prediction::tree_width, labels,
                                    std::vector<float>(labels.size(), 1.0F));
    detail::Booster booster(data, data, {{"max_depth", "5"}, {"learning_rate", "0.3"}});
    for (int tree = 0; tree < 25; ++tree)
        booster.grow();
    prediction::Weights weights;
    weights.architecture = prediction::boosted_trees_architecture;
    weights.features = prediction::tree_schema();
    weights.tensors = booster.tensors(25);
    // Through the file format, as it is shipped.
    const prediction::BoostedTrees trees(
        prediction::parse_weights(prediction::format_weights(weights), "trees"), prediction::tree_schema());
    const std::vector<float> logits = booster.logits(data);
    ASSERT_EQ(logits.size(), labels.size());
    for (std::size_t at = 0; at < logits.size(); ++at) {
        const auto row = std::span(inputs).subspan(at * prediction::tree_width, prediction::tree_width);
        ASSERT_NEAR(trees.sum(row), logits[at], 1e-5) << at;
    }
}

TEST(TrainGradientBoosting, SaysWhatTheDataLack) {
    EXPECT_THAT(message_of([] { train_gradient_boosting({}, {}); }), HasSubstr("--net graphsage"));
    EXPECT_THAT(message_of([] { train_gradient_boosting(runs(2), {}); }), HasSubstr("3 seeds or more"));
    std::vector<RepairSampleFile> one_class = runs(4, 4);
    for (RepairSampleFile& file : one_class) {
        for (samples::RepairSample& sample : file.samples)
            std::ranges::fill(sample.linked, std::uint8_t{0});
    }
    EXPECT_THAT(message_of([&] { train_gradient_boosting(one_class, {}); }),
                HasSubstr("hold only pairs that are not linked"));
    std::vector<RepairSampleFile> other_radius = runs(4, 4);
    other_radius[2].origin.link_radius_m = 20.0;
    EXPECT_THAT(message_of([&] { train_gradient_boosting(other_radius, {}); }),
                HasSubstr("links below 20 m"));
}

TEST(TrainGradientBoosting, AnInterruptedTrainingKeepsWhatItHas) {
    int asked = 0;
    TrainingHooks hooks;
    hooks.should_stop = [&] { return ++asked > 3; };
    const BoostingResult result = train_gradient_boosting(runs(4, 4), few_trees(), hooks);
    EXPECT_EQ(result.outcome, Outcome::interrupted);
    EXPECT_EQ(result.losses.size(), 3u);
    EXPECT_TRUE(result.groups.empty()) << "not measured";
    EXPECT_NO_THROW(prediction::BoostedTrees(result.weights(), prediction::tree_schema()));
}

TEST(TrainGradientBoosting, WritesAModelThatThePredictorTakes) {
    const support::TemporaryFolder folder;
    const BoostingConfig config = few_trees();
    const BoostingResult result = train_gradient_boosting(runs(4, 4), config);
    const auto summary = summary_of(result, identity_of(config, "0123"), "data");
    write_outputs(folder.path() / "out", result, summary);
    EXPECT_NO_THROW(prediction::check_model("gradient_boosting",
                                            (folder.path() / "out" / "gradient_boosting.weights").string()));
    EXPECT_EQ(summary["mode"], "gradient_boosting");
    EXPECT_EQ(summary["trees_kept"], result.best_round + 1);
    EXPECT_THAT(core::read_file(folder.path() / "out" / "metrics.csv"),
                HasSubstr("all,all,gradient_boosting"));
    EXPECT_THAT(core::read_file(folder.path() / "out" / "losses.csv"), HasSubstr("validation"));
}

}  // namespace
}  // namespace clearway::training
