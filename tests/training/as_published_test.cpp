#include "training/comparison/as_published.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "prediction/state_dict.hpp"

namespace clearway::training {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// Vehicles on a road of two lanes; every pair within 120 m is listed, linked below 50 m. Positions in km, so
/// that the losses stay moderate.
samples::PairDataset road(std::uint32_t seed, std::uint32_t vehicles) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(0.0F, 1.0F);
    samples::PairDataset dataset;
    dataset.feature_count = 2;
    for (std::uint32_t vehicle = 0; vehicle < vehicles; ++vehicle) {
        dataset.features.insert(dataset.features.end(),
                                {place(random), 0.0032F * static_cast<float>(random() % 2)});
    }
    for (std::uint32_t left = 0; left < vehicles; ++left) {
        for (std::uint32_t right = left + 1; right < vehicles; ++right) {
            const float gap = std::hypot(dataset.features[2 * left] - dataset.features[2 * right],
                                         dataset.features[2 * left + 1] - dataset.features[2 * right + 1]);
            if (gap > 0.12F) continue;
            dataset.source.push_back(left);
            dataset.target.push_back(right);
            dataset.label.push_back(gap < 0.05F ? 1.0F : 0.0F);
        }
    }
    return dataset;
}

TEST(OrderedSplit, takes_int_of_three_quarters_and_one_more) {
    // Python: train_n = int(n * (3 / 4)); train = list[:train_n + 1]; test = list[train_n + 1:].
    constexpr std::array<std::size_t, 10> train = {0, 1, 2, 3, 4, 4, 5, 6, 7, 7};
    for (std::size_t count = 0; count < train.size(); ++count) {
        EXPECT_EQ(ordered_split(count).train, train[count]) << count << " pairs";
        EXPECT_EQ(ordered_split(count).test, count - train[count]) << count << " pairs";
    }
    EXPECT_EQ(ordered_split(1000).train, 751U);
}

TEST(AsPublishedBatch, messages_are_the_pairs_of_its_part) {
    const samples::PairDataset dataset{2, {0, 0, 1, 0, 2, 0}, {0, 1, 2}, {1, 2, 0}, {1, 0, 1}};
    const GraphBatch batch = as_published_batch(dataset, 1, 2);
    EXPECT_EQ(batch.vehicle_count(), 3U);
    EXPECT_THAT(batch.pair_left, ElementsAre(1, 2));
    EXPECT_THAT(batch.pair_right, ElementsAre(2, 0));
    EXPECT_THAT(batch.label, ElementsAre(0.0F, 1.0F));
    EXPECT_EQ(batch.message_source, batch.pair_left);
    EXPECT_EQ(batch.message_target, batch.pair_right);
}

TEST(TrainAsPublished, runs_all_epochs_and_scores_every_pair) {
    const samples::PairDataset dataset = road(1, 40);
    std::vector<std::uint32_t> epochs;
    const AsPublishedResult result =
        train_as_published(dataset, PairChoice::candidates, {},
                           {[&](std::uint32_t epoch, const EpochLoss&) { epochs.push_back(epoch); }, {}});
    EXPECT_EQ(result.outcome, Outcome::finished);
    ASSERT_EQ(result.losses.size(), 100U);
    EXPECT_EQ(epochs.size(), 100U);
    EXPECT_EQ(epochs.back(), 99U);
    EXPECT_LT(result.losses.back().train, result.losses.front().train);
    EXPECT_EQ(result.logits.size(), dataset.pair_count());
    EXPECT_EQ(result.train_quality.pairs, result.split.train);
    EXPECT_EQ(result.test_quality.pairs, result.split.test);
    EXPECT_EQ(result.state.size(), 10U);
}

TEST(TrainAsPublished, losses_are_those_before_the_step_and_logits_those_after_the_last) {
    const samples::PairDataset dataset = road(2, 30);
    TrainingConfig config;
    config.epochs = 3;
    const AsPublishedResult result = train_as_published(dataset, PairChoice::candidates, config);
    const GraphBatch train = as_published_batch(dataset, 0, result.split.train);
    const GraphBatch test = as_published_batch(dataset, result.split.train, result.split.test);
    TorchNet net({{2, 10, 5}, config.seed, config.learning_rate});
    for (const EpochLoss& loss : result.losses) {
        EXPECT_EQ(loss.train, net.loss(train));
        EXPECT_EQ(loss.held_out, net.loss(test));
        net.train_step(train);
    }
    std::vector<float> logits = net.logits(train);
    for (const float logit : net.logits(test))
        logits.push_back(logit);
    EXPECT_EQ(result.logits, std::vector<double>(logits.begin(), logits.end()));
}

TEST(TrainAsPublished, same_seed_same_bytes_other_seed_other_bytes) {
    const samples::PairDataset dataset = road(3, 30);
    const auto bytes = [&](std::uint64_t seed) {
        TrainingConfig config;
        config.epochs = 20;
        config.seed = seed;
        return prediction::format_pth(train_as_published(dataset, PairChoice::candidates, config).state,
                                      "net");
    };
    EXPECT_EQ(bytes(1), bytes(1));
    EXPECT_NE(bytes(1), bytes(2));
}

TEST(TrainAsPublished, a_list_of_true_edges_gives_a_low_loss_that_a_constant_has_too) {
    const AsPublishedResult result = train_as_published(road(4, 60), PairChoice::true_only, {});
    EXPECT_THAT(result.dataset.label, testing::Each(1.0F));
    EXPECT_LT(result.losses.back().held_out, 0.01);
    EXPECT_LT(result.constant_test_loss, 1e-9);
    EXPECT_FALSE(result.test_quality.auc);
    EXPECT_THAT(result.warnings, Contains(HasSubstr("every training label is 1")));
    EXPECT_THAT(result.warnings, Contains(HasSubstr("every test label is 1")));
}

TEST(TrainAsPublished, the_constant_s_loss_is_that_of_the_training_share) {
    // 4 train pairs, 3 of them linked; 1 test pair, not linked: -ln(1 - 3/4).
    const samples::PairDataset dataset{
        2, {0, 0, 1, 0, 2, 0}, {0, 1, 2, 0, 1}, {1, 2, 0, 2, 0}, {1, 1, 0, 1, 0}};
    const AsPublishedResult result = train_as_published(dataset, PairChoice::candidates, {});
    EXPECT_NEAR(result.constant_test_loss, std::log(4.0), 1e-6);
    EXPECT_THAT(result.warnings, Contains(HasSubstr("every test label is 0")));
}

TEST(TrainAsPublished, too_few_pairs_are_refused) {
    samples::PairDataset dataset{2, {0, 0, 1, 0}, {0, 1, 0, 1}, {1, 0, 1, 0}, {1, 0, 1, 0}};
    EXPECT_THROW(train_as_published(dataset, PairChoice::candidates, {}), core::InputError);
    dataset = road(5, 30);
    std::ranges::fill(dataset.label, 0.0F);
    try {
        train_as_published(dataset, PairChoice::true_only, {});
        FAIL() << "no true pair was accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("0 true pairs (allowed: 5 or more)"));
    }
}

TEST(TrainAsPublished, divergence_keeps_the_last_parameters_with_finite_losses) {
    TrainingConfig config;
    config.learning_rate = 1e20;
    const samples::PairDataset dataset = road(6, 30);
    const AsPublishedResult result = train_as_published(dataset, PairChoice::candidates, config);
    EXPECT_EQ(result.outcome, Outcome::diverged);
    ASSERT_EQ(result.losses.size(), 2U);
    EXPECT_TRUE(std::isfinite(result.losses[0].train));
    EXPECT_FALSE(std::isfinite(result.losses[1].train) && std::isfinite(result.losses[1].held_out));
    EXPECT_EQ(prediction::format_pth(result.state, "net"),
              prediction::format_pth(TorchNet({{2, 10, 5}, config.seed, 0.01}).state(), "net"));
}

TEST(TrainAsPublished, divergence_in_the_last_step_is_noticed) {
    TrainingConfig config;
    config.learning_rate = 1e20;
    config.epochs = 1;
    const AsPublishedResult result = train_as_published(road(6, 30), PairChoice::candidates, config);
    EXPECT_EQ(result.outcome, Outcome::diverged);
    EXPECT_FALSE(result.state.empty());
    EXPECT_THAT(result.logits,
                testing::Each(testing::Truly([](float logit) { return std::isfinite(logit); })));
}

TEST(TrainAsPublished, data_that_diverge_at_once_leave_no_parameters) {
    samples::PairDataset dataset = road(7, 30);
    for (float& value : dataset.features)
        value *= 1e38F;
    const AsPublishedResult result = train_as_published(dataset, PairChoice::candidates, {});
    EXPECT_EQ(result.outcome, Outcome::diverged);
    EXPECT_TRUE(result.state.empty());
    EXPECT_EQ(result.losses.size(), 1U);
}

TEST(QualityOfLogits, ranks_logits_whose_probabilities_round_to_one) {
    const metrics::LinkQuality quality = quality_of_logits({100.0, 90.0, 80.0}, {1, 0, 0});
    EXPECT_EQ(quality.auc, 1.0);
    EXPECT_EQ(quality.ap, 1.0);
    EXPECT_EQ(quality.f1, 0.5);
}

TEST(ScoreUnseen, messages_are_listed_pairs_true_links_or_none) {
    const samples::PairDataset unseen = road(21, 30);
    TrainingConfig config;
    const StateDict state = TorchNet({{2, 10, 5}, 4, 0.01}).state();
    const UnseenQuality quality = score_unseen(state, config, unseen, "other");
    TorchNet net({{2, 10, 5}, 1, 0.01});
    net.load(state);
    const auto auc = [&](const std::function<bool(std::size_t)>& carries_message) {
        GraphBatch batch = as_published_batch(unseen, 0, unseen.pair_count());
        batch.message_source.clear();
        batch.message_target.clear();
        for (std::size_t pair = 0; pair < unseen.pair_count(); ++pair) {
            if (!carries_message(pair)) continue;
            batch.message_source.push_back(unseen.source[pair]);
            batch.message_target.push_back(unseen.target[pair]);
        }
        const std::vector<float> logits = net.logits(batch);
        return quality_of_logits({logits.begin(), logits.end()}, link_flags(batch.label)).auc;
    };
    EXPECT_EQ(quality.listed.auc, auc([](std::size_t) { return true; }));
    EXPECT_EQ(quality.true_links.auc, auc([&](std::size_t pair) { return unseen.label[pair] == 1.0F; }));
    EXPECT_EQ(quality.no_messages.auc, auc([](std::size_t) { return false; }));
    EXPECT_NE(quality.listed.auc, quality.no_messages.auc);
}

TEST(ScoreUnseen, other_features_are_refused) {
    const StateDict state = TorchNet({{5, 10, 5}, 4, 0.01}).state();
    try {
        score_unseen(state, {}, road(21, 30), "other");
        FAIL() << "2 features were accepted for a net of 5";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("other/vehicle_features.csv: 2 features a vehicle (allowed: 5)"));
    }
}

TEST(TrainAsPublished, stops_when_asked_and_keeps_what_it_has) {
    int asked = 0;
    const AsPublishedResult result =
        train_as_published(road(8, 30), PairChoice::candidates, {}, {{}, [&] { return ++asked > 5; }});
    EXPECT_EQ(result.outcome, Outcome::interrupted);
    EXPECT_EQ(result.losses.size(), 5U);
    EXPECT_FALSE(result.state.empty());
}

}  // namespace
}  // namespace clearway::training
