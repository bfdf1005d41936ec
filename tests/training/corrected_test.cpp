#include "training/comparison/corrected.hpp"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "prediction/state_dict.hpp"
#include "support/message_of.hpp"
#include "synthetic_samples.hpp"

namespace clearway::training {
namespace {

using support::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<DataSeed> seeds_upto(std::uint32_t count) {
    std::vector<DataSeed> seeds;
    for (std::uint32_t replication = 0; replication < count; ++replication)
        seeds.push_back({1, replication});
    return seeds;
}

TEST(AppendSample, moves_indices_behind_the_vehicles_already_there) {
    const samples::GraphSample two{0.0, 2, {1, 2}, {{0, 1}}, {{0, 1, 10.0F, 1}}};
    const samples::GraphSample three{1.0, 3, {3, 4, 5}, {{1, 2}}, {{0, 2, 60.0F, 0}}};
    GraphBatch batch;
    append_sample(two, 1, 200.0, batch);
    append_sample(three, 1, 200.0, batch);
    EXPECT_THAT(batch.features, ElementsAre(1, 2, 3, 4, 5));
    EXPECT_THAT(batch.message_source, ElementsAre(0, 1, 3, 4));
    EXPECT_THAT(batch.message_target, ElementsAre(1, 0, 4, 3));
    EXPECT_THAT(batch.pair_left, ElementsAre(0, 2));
    EXPECT_THAT(batch.pair_right, ElementsAre(1, 4));
    EXPECT_THAT(batch.label, ElementsAre(1.0F, 0.0F));
}

TEST(AppendSample, a_batch_scores_each_snapshot_as_if_alone) {
    const samples::GraphSampleFile file = SyntheticRun(5).file(0, 4);
    const TorchNet net({{5, 10, 5}, 5, 0.01});
    GraphBatch together;
    std::vector<float> alone;
    for (const samples::GraphSample& sample : file.samples) {
        append_sample(sample, 5, 200.0, together);
        GraphBatch single;
        append_sample(sample, 5, 200.0, single);
        for (const float logit : net.logits(single))
            alone.push_back(logit);
    }
    EXPECT_GT(alone.size(), 100U);
    EXPECT_THAT(net.logits(together), testing::Pointwise(testing::FloatNear(1e-6F), alone));
}

TEST(AppendSample, messages_flow_along_observed_edges_only) {
    samples::GraphSample sample = SyntheticRun(6).file(0, 1).samples[0];
    GraphBatch before;
    append_sample(sample, 5, 200.0, before);
    EXPECT_EQ(before.message_source.size(), 2 * sample.observed_edges.size());
    // Labels and candidates move no message.
    for (samples::CandidatePair& pair : sample.candidates)
        pair.linked = 1 - pair.linked;
    GraphBatch flipped;
    append_sample(sample, 5, 200.0, flipped);
    EXPECT_EQ(flipped.message_source, before.message_source);
    EXPECT_EQ(flipped.message_target, before.message_target);
    const TorchNet net({{5, 10, 5}, 6, 0.01});
    EXPECT_EQ(net.logits(flipped), net.logits(before));
}

TEST(AppendSample, pairs_out_of_reach_are_left_out) {
    const samples::GraphSample sample{
        0.0, 3, {1, 2, 3}, {}, {{0, 1, 199.0F, 0}, {0, 2, 200.0F, 0}, {1, 2, 250.0F, 1}}};
    GraphBatch batch;
    append_sample(sample, 1, 200.0, batch);
    EXPECT_THAT(batch.pair_right, ElementsAre(1));
}

TEST(SplitSeeds, every_seed_is_in_one_part) {
    const SeedSplit split = split_seeds(seeds_upto(20), {});
    EXPECT_EQ(split.test.size(), 4U);
    EXPECT_EQ(split.validation.size(), 4U);
    EXPECT_EQ(split.train.size(), 12U);
    std::set<DataSeed> all;
    for (const auto* part : {&split.train, &split.validation, &split.test}) {
        EXPECT_TRUE(std::ranges::is_sorted(*part));
        all.insert(part->begin(), part->end());
    }
    EXPECT_EQ(all.size(), 20U);
}

TEST(SplitSeeds, neither_order_nor_repetition_of_the_files_matters) {
    std::vector<DataSeed> seeds = seeds_upto(10);
    const SeedSplit split = split_seeds(seeds, {});
    std::ranges::reverse(seeds);
    seeds.insert(seeds.end(), seeds.begin(), seeds.begin() + 5);
    EXPECT_EQ(split_seeds(seeds, {}).test, split.test);
    EXPECT_EQ(split_seeds(seeds, {}).train, split.train);
}

TEST(SplitSeeds, the_training_seed_deals_them) {
    SplitShares other;
    other.seed = 2;
    EXPECT_NE(split_seeds(seeds_upto(40), {}).test, split_seeds(seeds_upto(40), other).test);
}

TEST(SplitSeeds, no_part_is_empty) {
    SplitShares greedy;
    greedy.test = 0.8;
    greedy.validation = 0.8;
    EXPECT_THAT(message_of([&] { split_seeds(seeds_upto(10), greedy); }),
                HasSubstr("0.8 and 0.8 take 8 and 8 of 10 seeds (allowed: shares that leave a seed"));
    SplitShares sparing;
    sparing.test = 0.01;
    sparing.validation = 0.01;
    const SeedSplit split = split_seeds(seeds_upto(3), sparing);
    EXPECT_EQ(split.train.size(), 1U);
    EXPECT_EQ(split.validation.size(), 1U);
    EXPECT_EQ(split.test.size(), 1U);
    EXPECT_THAT(message_of([] { split_seeds(seeds_upto(2), {}); }),
                HasSubstr("2 seeds (allowed: 3 seeds or more)"));
}

TEST(TrainCorrected, learns_links_of_unseen_seeds) {
    CorrectedConfig config;
    config.training.epochs = 30;
    const CorrectedResult result = train_corrected(synthetic_files(10, 40), config);
    ASSERT_EQ(result.groups.size(), 3U) << "all, by failure, by scenario and failure";
    const metrics::LinkQuality& quality = result.groups[0].model;
    EXPECT_GT(quality.pairs, 1000U);
    EXPECT_GT(*quality.auc, 0.9);
    EXPECT_GT(*quality.f1, 0.75);
    EXPECT_LT(*quality.log_loss, 0.45);
    EXPECT_LT(*quality.ece, 0.1);
    EXPECT_EQ(result.groups[2].scenario, "line");
    EXPECT_EQ(result.groups[2].model.pairs, quality.pairs);
    EXPECT_GT(*result.groups[0].reference->auc, 0.9);
}

TEST(TrainCorrected, shuffled_labels_teach_nothing) {
    std::vector<samples::GraphSampleFile> files = synthetic_files(10, 40);
    std::mt19937 random(1);
    for (samples::GraphSampleFile& file : files) {
        for (samples::GraphSample& sample : file.samples) {
            for (samples::CandidatePair& pair : sample.candidates)
                pair.linked = random() % 2 == 0 ? 1 : 0;
        }
    }
    CorrectedConfig config;
    config.training.epochs = 10;
    EXPECT_NEAR(*train_corrected(files, config).groups[0].model.auc, 0.5, 0.06);
}

TEST(TrainCorrected, keeps_the_epoch_that_validates_best_and_stops_early) {
    CorrectedConfig config;
    config.training.epochs = 1000;
    config.training.learning_rate = 0.05;
    config.patience = 2;
    const CorrectedResult result = train_corrected(synthetic_files(5, 10), config);
    EXPECT_EQ(result.outcome, Outcome::stopped_early);
    ASSERT_LT(result.losses.size(), 1000U);
    EXPECT_EQ(result.best_round + 2, result.losses.size() - 1);
    for (const EpochLoss& loss : result.losses)
        EXPECT_GE(loss.held_out, result.losses[result.best_round].held_out);
}

TEST(TrainCorrected, same_seed_same_bytes) {
    CorrectedConfig config;
    config.training.epochs = 3;
    const auto files = synthetic_files(4, 10);
    const std::string first = prediction::format_pth(train_corrected(files, config).state, "net");
    EXPECT_EQ(prediction::format_pth(train_corrected(files, config).state, "net"), first);
    config.training.seed = 2;
    EXPECT_NE(prediction::format_pth(train_corrected(files, config).state, "net"), first);
}

TEST(TrainCorrected, candidates_out_of_reach_count_as_predicted_unlinked) {
    auto files = synthetic_files(3, 5);
    std::uint64_t within = 0;
    CorrectedConfig config;
    config.training.epochs = 2;
    within = train_corrected(files, config).groups[0].model.pairs;
    for (samples::GraphSampleFile& file : files)
        file.samples[0].candidates.push_back({0, 1, 500.0F, 1});
    const CorrectedResult result = train_corrected(files, config);
    EXPECT_EQ(result.groups[0].model.pairs, within + 1);
    // A true link with probability 0 costs 15 ln 10 at the clamp.
    EXPECT_GT(*result.groups[0].model.log_loss * static_cast<double>(within + 1), 15 * std::log(10.0));
}

TEST(TrainCorrected, divergence_keeps_the_best_epoch) {
    CorrectedConfig config;
    config.training.learning_rate = 1e20;
    const CorrectedResult result = train_corrected(synthetic_files(3, 40), config);
    EXPECT_EQ(result.outcome, Outcome::diverged);
    EXPECT_TRUE(result.state.empty());
    EXPECT_TRUE(result.groups.empty());
}

TEST(TrainCorrected, files_of_different_features_are_refused) {
    auto files = synthetic_files(3, 2);
    files[1].origin.features.version = 99;
    EXPECT_THAT(message_of([&] { train_corrected(files, {}); }),
                testing::AllOf(HasSubstr("line, B10, replication 1"), HasSubstr("corrected 99")));
    EXPECT_THAT(message_of([] { train_corrected({}, {}); }), HasSubstr("no samples"));
}

TEST(TrainCorrected, a_part_without_pairs_is_said) {
    auto files = synthetic_files(3, 2);
    for (auto& file : files) {
        for (auto& sample : file.samples)
            sample.candidates.clear();
    }
    EXPECT_THAT(message_of([&] { train_corrected(files, {}); }),
                HasSubstr("the training seeds hold no candidate pair"));
}

TEST(TrainCorrected, a_part_of_one_class_is_said) {
    for (const std::uint8_t label : {std::uint8_t{0}, std::uint8_t{1}}) {
        auto files = synthetic_files(3, 4);
        const DataSeed of_test = train_corrected(files, {}, {{}, [] { return true; }}).seeds.test.front();
        for (auto& file : files) {
            if (file.origin.replication != of_test.replication) continue;
            for (auto& sample : file.samples) {
                for (auto& pair : sample.candidates)
                    pair.linked = label;
            }
        }
        EXPECT_THAT(message_of([&] { train_corrected(files, {}); }),
                    HasSubstr(label == 1 ? "the test seeds hold only pairs that are linked"
                                         : "the test seeds hold only pairs that are not linked"));
    }
}

TEST(TrainCorrected, interruption_keeps_the_best_so_far) {
    int asked = 0;
    const CorrectedResult result =
        train_corrected(synthetic_files(3, 5), {}, {{}, [&] { return ++asked > 2; }});
    EXPECT_EQ(result.outcome, Outcome::interrupted);
    EXPECT_EQ(result.losses.size(), 2U);
    EXPECT_FALSE(result.state.empty());
    EXPECT_FALSE(result.groups.empty());
}

}  // namespace
}  // namespace clearway::training
