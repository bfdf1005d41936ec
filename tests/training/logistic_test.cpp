#include "training/comparison/logistic.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/random.hpp"
#include "prediction/predictor.hpp"
#include "prediction/weights.hpp"
#include "support/temporary_folder.hpp"
#include "training/outputs.hpp"

namespace clearway::training {
namespace {

using testing::HasSubstr;

constexpr std::array<double, 8> true_weight = {1.0, -0.5, 0.25, 0.0, 2.0, 0.0, -1.0, 0.5};
constexpr double true_bias = -0.75;

/// Pairs of one seed, drawn from a logistic model with the weights above.
samples::PairSampleFile drawn_pairs(std::uint32_t replication, std::size_t count) {
    const core::KeyedRandom random(core::StudySeed{5}, core::Replication{replication});
    samples::PairSampleFile file;
    file.origin.scenario = "drawn";
    file.origin.failure = "B10";
    file.origin.replication = replication;
    for (std::size_t pair = 0; pair < count; ++pair) {
        prediction::PairFeatures features{};
        double logit = true_bias;
        for (std::size_t i = 0; i < features.size(); ++i) {
            features[i] = static_cast<float>(random.normal(core::Purpose::training, i, pair));
            logit += true_weight[i] * features[i];
        }
        file.features.push_back(features);
        file.linked.push_back(
            random.uniform(core::Purpose::training, 99, pair) < 1.0 / (1.0 + std::exp(-logit)) ? 1 : 0);
    }
    return file;
}

std::vector<samples::PairSampleFile> drawn_files(std::uint32_t seeds) {
    std::vector<samples::PairSampleFile> files;
    for (std::uint32_t seed = 0; seed < seeds; ++seed)
        files.push_back(drawn_pairs(seed, 6000));
    return files;
}

std::string refusal(const std::vector<samples::PairSampleFile>& files, const LogisticConfig& config = {}) {
    try {
        train_logistic(files, config);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(TrainLogistic, FindsTheModelThatMadeTheData) {
    const LogisticResult result = train_logistic(drawn_files(10), {});
    EXPECT_TRUE(result.converged);
    EXPECT_LT(result.iterations, 15u);
    EXPECT_EQ(result.seeds.train.size(), 6u);
    EXPECT_EQ(result.train_pairs, 36000u);
    // 36,000 pairs: standard errors of about 0.02 to 0.03.
    for (std::size_t i = 0; i < true_weight.size(); ++i) {
        EXPECT_NEAR(result.weight[i], true_weight[i], 0.1) << i;
    }
    EXPECT_NEAR(result.bias, true_bias, 0.1);
    EXPECT_LT(*result.groups[0].model.ece, 0.02);
    EXPECT_EQ(result.groups[2].scenario, "drawn");
}

TEST(TrainLogistic, ReachesAMinimumOfTheLoss) {
    std::vector<samples::PairSampleFile> files = drawn_files(5);
    const LogisticResult result = train_logistic(files, {});
    // The gradient, by an own sum: mean of (p - y) x must vanish.
    std::array<double, 9> gradient{};
    double pairs = 0.0;
    for (const samples::PairSampleFile& file : files) {
        const DataSeed seed{file.origin.study_seed, file.origin.replication};
        if (std::ranges::find(result.seeds.train, seed) == result.seeds.train.end()) continue;
        for (std::size_t pair = 0; pair < file.linked.size(); ++pair) {
            double logit = result.bias;
            for (std::size_t i = 0; i < 8; ++i) {
                logit += static_cast<double>(result.weight[i]) * file.features[pair][i];
            }
            const double error = 1.0 / (1.0 + std::exp(-logit)) - file.linked[pair];
            for (std::size_t i = 0; i < 8; ++i) {
                gradient[i] += error * file.features[pair][i];
            }
            gradient[8] += error;
            ++pairs;
        }
    }
    for (const double part : gradient) {
        EXPECT_NEAR(part / pairs, 0.0, 1e-5);
    }
}

TEST(TrainLogistic, StaysFiniteWhereTheClassesCanBeSeparated) {
    std::vector<samples::PairSampleFile> files = drawn_files(3);
    for (samples::PairSampleFile& file : files) {
        for (std::size_t pair = 0; pair < file.linked.size(); ++pair) {
            file.linked[pair] = file.features[pair][0] > 0.0F ? 1 : 0;
        }
    }
    const LogisticResult result = train_logistic(files, {});
    EXPECT_GT(result.weight[0], 10.0F);
    EXPECT_TRUE(std::isfinite(result.weight[0]) && std::isfinite(result.train_loss));
}

TEST(TrainLogistic, RefusesDataThatTeachNothing) {
    EXPECT_THAT(refusal(drawn_files(2)), HasSubstr("3 seeds or more"));
    std::vector<samples::PairSampleFile> one_class = drawn_files(4);
    for (samples::PairSampleFile& file : one_class)
        std::ranges::fill(file.linked, std::uint8_t{1});
    EXPECT_THAT(refusal(one_class), HasSubstr("the training seeds hold only pairs that are linked"));
    std::vector<samples::PairSampleFile> empty = drawn_files(4);
    for (samples::PairSampleFile& file : empty) {
        file.features.clear();
        file.linked.clear();
    }
    EXPECT_THAT(refusal(empty), HasSubstr("the training seeds hold no candidate pair"));
    std::vector<samples::PairSampleFile> mixed = drawn_files(4);
    mixed[2].origin.link_radius_m = 80.0;
    EXPECT_THAT(refusal(mixed), HasSubstr("links below 80 m"));
    std::vector<samples::PairSampleFile> constant = drawn_files(4);
    for (samples::PairSampleFile& file : constant) {
        for (prediction::PairFeatures& features : file.features)
            features[3] = 1.0F;
    }
    EXPECT_THAT(refusal(constant, {.ridge = 0.0}), HasSubstr("--ridge"));
}

TEST(TrainLogistic, WritesAModelThatThePredictorTakes) {
    const support::TemporaryFolder folder;
    const LogisticResult result = train_logistic(drawn_files(3), {});
    const auto summary = summary_of(result, identity_of(LogisticConfig{}, "0123"), "data");
    write_outputs(folder.path(), result, summary);
    const prediction::Weights weights = prediction::read_weights(folder.path() / "logistic.weights");
    EXPECT_NO_THROW(weights.require("logistic_pairs", prediction::pair_feature_schema()));
    EXPECT_NO_THROW(prediction::check_model("logistic", (folder.path() / "logistic.weights").string()));
    EXPECT_EQ(weights.tensor("weight", {1, 8}).values[2], result.weight[2]);
    EXPECT_EQ(summary["mode"], "logistic");
    EXPECT_EQ(summary["test"][1]["failure"], "B10");
}

}  // namespace
}  // namespace clearway::training
