#include "links/link_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "links/link_scores.hpp"

namespace clearway::links {
namespace {

/// Scored pairs both ways: one by one, and counted on the grid.
struct Sample {
    std::vector<double> probability;
    std::vector<std::uint8_t> linked;
    LinkHistogram histogram;

    void add(float value, bool is_linked) {
        probability.push_back(static_cast<double>(value));
        linked.push_back(is_linked ? 1 : 0);
        histogram.add(value, is_linked);
    }
    metrics::LinkQuality exact(double threshold) const {
        return metrics::link_quality({probability, linked}, threshold);
    }
};

/// Probabilities whose logits are normal around `centre`; links as likely as stated, or less so.
Sample random_sample(std::uint32_t seed, float centre, float spread, float honesty) {
    std::mt19937 engine(seed);
    std::normal_distribution<float> logit(centre, spread);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    Sample sample;
    for (int i = 0; i < 20000; ++i) {
        const float x = logit(engine);
        const float probability = 1.0F / (1.0F + std::exp(-x));
        const float truth = 1.0F / (1.0F + std::exp(-honesty * x));
        sample.add(probability, uniform(engine) < truth);
    }
    return sample;
}

TEST(LinkGrid, orders_bins_as_probabilities_and_knows_their_lower_edges_exactly) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> exponent(-80.0F, 0.0F);
    std::vector<float> values = {0.0F, 1.0F, 0.5F, std::nextafter(0.5F, 0.0F), std::nextafter(1.0F, 0.0F)};
    for (int i = 0; i < 3000; ++i) {
        const float small = std::exp2(exponent(engine));
        values.insert(values.end(), {small, 1.0F - small, 0.5F - 0.5F * small});
    }
    std::ranges::sort(values);
    std::uint32_t last = 0;
    for (const float value : values) {
        const std::uint32_t bin = LinkGrid::bin_of(value);
        ASSERT_LT(bin, LinkGrid::size);
        EXPECT_GE(bin, last) << value;
        EXPECT_GE(value, LinkGrid::lower_edge(bin));
        if (bin + 1 < LinkGrid::size) {
            EXPECT_LT(value, LinkGrid::lower_edge(bin + 1));
        }
        last = bin;
    }
    EXPECT_EQ(LinkGrid::bin_of(0.0F), 0U);
    EXPECT_EQ(LinkGrid::bin_of(1.0F), LinkGrid::size - 1);
}

TEST(LinkGrid, bins_are_no_wider_than_a_64th_of_the_smaller_odds) {
    for (float value = 0x1p-23F; value < 0.999F; value *= 1.01F) {
        const std::uint32_t bin = LinkGrid::bin_of(value);
        const float low = LinkGrid::lower_edge(bin);
        const float high = LinkGrid::lower_edge(bin + 1);
        EXPECT_LE(high - low, std::min(low, 1.0F - low) / 63.0F) << value;
    }
}

class HistogramAgainstExact : public testing::TestWithParam<Sample (*)()> {};

TEST_P(HistogramAgainstExact, gives_the_same_measures) {
    const Sample sample = GetParam()();
    const LinkSummary summary = sample.histogram.summary();
    const double threshold = best_f1_threshold(summary);
    const metrics::LinkQuality exact = sample.exact(threshold);
    const metrics::LinkQuality counted = link_quality(summary, threshold);
    EXPECT_EQ(counted.pairs, exact.pairs);
    EXPECT_EQ(counted.true_links, exact.true_links);
    // Pairs of one bin are tied, which can only lower AP.
    EXPECT_LE(counted.ap.value(), exact.ap.value() + 1e-6);
    EXPECT_NEAR(counted.ap.value(), exact.ap.value(), 1e-3);
    EXPECT_NEAR(counted.auc.value(), exact.auc.value(), 1e-4);
    EXPECT_DOUBLE_EQ(counted.f1.value(), exact.f1.value());
    EXPECT_NEAR(counted.log_loss.value(), exact.log_loss.value(), 1e-7);
    EXPECT_NEAR(counted.ece.value(), exact.ece.value(), 1e-7);
    EXPECT_NEAR(brier_score(summary).value(),
                metrics::brier_score({sample.probability, sample.linked}).value(), 1e-9);
    const double best = metrics::best_f1_threshold({sample.probability, sample.linked});
    EXPECT_NEAR(counted.f1.value(), sample.exact(best).f1.value(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Samples, HistogramAgainstExact,
                         testing::Values([] { return random_sample(1, -2.0F, 3.0F, 1.0F); },
                                         [] { return random_sample(2, -5.0F, 4.0F, 2.0F); },
                                         [] { return random_sample(3, 0.0F, 8.0F, 0.5F); },
                                         [] { return random_sample(4, 3.0F, 1.0F, 1.0F); }));

TEST(LinkHistogram, counts_certainties_and_ties) {
    Sample sample;
    for (const auto& [value, linked] :
         {std::pair(1.0F, true), std::pair(1.0F, false), std::pair(0.0F, false), std::pair(0.0F, true),
          std::pair(0.25F, true), std::pair(0.25F, false), std::pair(1e-10F, false)})
        sample.add(value, linked);
    const metrics::LinkQuality exact = sample.exact(0.5);
    const metrics::LinkQuality counted = link_quality(sample.histogram.summary(), 0.5);
    EXPECT_DOUBLE_EQ(counted.ap.value(), exact.ap.value());
    EXPECT_DOUBLE_EQ(counted.auc.value(), exact.auc.value());
    EXPECT_DOUBLE_EQ(counted.f1.value(), exact.f1.value());
    EXPECT_NEAR(counted.log_loss.value(), exact.log_loss.value(), 1e-6);
    // Of seven pairs two are certain and wrong; of the ties one is 0.75 off and one 0.25.
    EXPECT_NEAR(brier_score(sample.histogram.summary()).value(), (2.0 + 0.5625 + 0.0625) / 7.0, 1e-9);
}

TEST(LinkSummary, of_nothing_has_no_measures) {
    const LinkSummary empty = LinkHistogram().summary();
    const metrics::LinkQuality quality = link_quality(empty);
    EXPECT_EQ(quality.pairs, 0U);
    EXPECT_FALSE(quality.ap || quality.auc || quality.f1 || quality.log_loss || quality.ece);
    EXPECT_FALSE(brier_score(empty).has_value());
    EXPECT_EQ(best_f1_threshold(empty), 0.5);
    EXPECT_TRUE(precision_recall(empty).empty());
}

TEST(LinkSummary, adds_up_to_the_same_in_any_order) {
    std::vector<LinkSummary> parts;
    LinkHistogram all;
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        const Sample sample = random_sample(seed, -1.0F, 1.0F + static_cast<float>(seed), 1.0F);
        parts.push_back(sample.histogram.summary());
        for (std::size_t i = 0; i < sample.linked.size(); ++i)
            all.add(static_cast<float>(sample.probability[i]), sample.linked[i] != 0);
    }
    LinkSummary forwards;
    LinkSummary backwards;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        forwards.add(parts[i]);
        backwards.add(parts[parts.size() - 1 - i]);
    }
    EXPECT_EQ(forwards, backwards);
    EXPECT_EQ(forwards, all.summary());
}

TEST(LinkSummary, traces_precision_and_recall_from_the_top) {
    LinkHistogram histogram;
    histogram.add(0.9F, true);
    histogram.add(0.8F, false);
    histogram.add(0.3F, true);
    const std::vector<PrecisionRecall> curve = precision_recall(histogram.summary());
    ASSERT_EQ(curve.size(), 3U);
    EXPECT_DOUBLE_EQ(curve[0].precision, 1.0);
    EXPECT_DOUBLE_EQ(curve[0].recall, 0.5);
    EXPECT_DOUBLE_EQ(curve[1].precision, 0.5);
    EXPECT_DOUBLE_EQ(curve[2].precision, 2.0 / 3.0);
    EXPECT_DOUBLE_EQ(curve[2].recall, 1.0);
    EXPECT_LE(curve[0].threshold, 0.9);
    EXPECT_GT(curve[0].threshold, 0.88);
}

TEST(LinkScores, sort_pairs_by_age_difficulty_and_use_to_a_policy) {
    LinkScores scores;
    scores.add(0.9F, true, {.age_class = age_class_of(0.0F), .hard = false, .ahead_of_emergency = true});
    scores.add(0.4F, false, {.age_class = age_class_of(7.0F), .hard = true, .ahead_of_emergency = false});
    scores.add(0.6F, true, {.age_class = age_class_of(7.0F), .hard = false, .ahead_of_emergency = false});
    const LinkScoreSummary summary = scores.summary();
    EXPECT_EQ(summary.of(LinkSubset::all).pairs(), 3U);
    EXPECT_EQ(summary.of(LinkSubset::hard).pairs(), 1U);
    EXPECT_EQ(summary.of(LinkSubset::policy).pairs(), 1U);
    EXPECT_EQ(summary.of_age(0).pairs(), 1U);
    EXPECT_EQ(summary.of_age(3).pairs(), 2U);
    LinkScoreSummary twice = summary;
    twice.add(summary);
    EXPECT_EQ(twice.of(LinkSubset::all).true_links(), 4U);
}

TEST(LinkScores, ages_belong_to_the_class_that_they_end) {
    EXPECT_EQ(age_class_of(0.0F), 0U);
    EXPECT_EQ(age_class_of(1.0F), 0U);
    EXPECT_EQ(age_class_of(1.01F), 1U);
    EXPECT_EQ(age_class_of(20.0F), 4U);
    EXPECT_EQ(age_class_of(1000.0F), age_classes - 1);
}

TEST(LinkScores, hard_is_near_the_radius_or_contested) {
    EXPECT_TRUE(is_hard(10.0F, 60.0F, 50.0F));
    EXPECT_TRUE(is_hard(30.0F, 30.0F, 50.0F));
    EXPECT_TRUE(is_hard(10.0F, 110.0F, 50.0F)) << "linked when last seen, far off by dead reckoning";
    EXPECT_FALSE(is_hard(10.0F, 20.0F, 50.0F));
    EXPECT_FALSE(is_hard(90.0F, 75.0F, 50.0F));
}

}  // namespace
}  // namespace clearway::links
