#include "metrics/link_quality.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clearway::metrics {
namespace {

/// Owns what ScoredLinks refers to.
struct Links {
    std::vector<double> probability;
    std::vector<std::uint8_t> linked;
    operator ScoredLinks() const { return {probability, linked}; }
};

TEST(LinkQuality, area_counts_ordered_pairs) {
    // 0.9+ 0.7- 0.6+ 0.2-: of the four (true, false) pairs only (0.6, 0.7) is in the wrong order.
    EXPECT_DOUBLE_EQ(*area_under_roc(Links{{0.9, 0.7, 0.6, 0.2}, {1, 0, 1, 0}}), 0.75);
    EXPECT_DOUBLE_EQ(*area_under_roc(Links{{0.2, 0.6, 0.7, 0.9}, {1, 1, 0, 0}}), 0.0);
}

TEST(LinkQuality, ties_count_half_in_the_area) {
    EXPECT_DOUBLE_EQ(*area_under_roc(Links{{0.4, 0.4, 0.4}, {1, 0, 0}}), 0.5);
    // (0.8, 0.5) right, (0.5, 0.5) half.
    EXPECT_DOUBLE_EQ(*area_under_roc(Links{{0.8, 0.5, 0.5}, {1, 1, 0}}), 0.75);
}

TEST(LinkQuality, area_agrees_with_the_count_of_all_pairs) {
    Links links;
    std::uint32_t state = 12345;
    for (int row = 0; row < 300; ++row) {
        state = state * 1664525U + 1013904223U;
        links.probability.push_back((state >> 24U) % 40 / 40.0);
        links.linked.push_back((state >> 9U) % 3 == 0);
    }
    double won = 0.0, all = 0.0;
    for (std::size_t i = 0; i < 300; ++i) {
        for (std::size_t j = 0; j < 300; ++j) {
            if (links.linked[i] != 1 || links.linked[j] != 0) continue;
            all += 1.0;
            const double gap = links.probability[i] - links.probability[j];
            won += gap > 0 ? 1.0 : gap == 0 ? 0.5 : 0.0;
        }
    }
    EXPECT_NEAR(*area_under_roc(links), won / all, 1e-12);
}

TEST(LinkQuality, average_precision_steps_over_recall) {
    // Recall 1/2 at precision 1, then 1 at precision 2/3.
    EXPECT_DOUBLE_EQ(*average_precision(Links{{0.9, 0.7, 0.6, 0.2}, {1, 0, 1, 0}}), 0.5 + 0.5 * 2.0 / 3.0);
}

TEST(LinkQuality, tied_pairs_enter_the_average_precision_together) {
    EXPECT_DOUBLE_EQ(*average_precision(Links{{0.3, 0.3, 0.3, 0.3}, {0, 0, 0, 1}}), 0.25);
    EXPECT_DOUBLE_EQ(*average_precision(Links{{0.3, 0.3, 0.3, 0.3}, {1, 0, 0, 0}}), 0.25);
}

TEST(LinkQuality, f1_counts_the_threshold_as_predicted) {
    const Links links{{0.9, 0.5, 0.4, 0.1}, {1, 0, 1, 0}};
    EXPECT_DOUBLE_EQ(*f1_score(links, 0.5), 2.0 / 4.0);   // TP 1, FP 1, FN 1
    EXPECT_DOUBLE_EQ(*f1_score(links, 0.51), 2.0 / 3.0);  // TP 1, FN 1
    EXPECT_DOUBLE_EQ(*f1_score(links, 0.0), 4.0 / 6.0);   // all predicted
    EXPECT_EQ(f1_score(Links{{0.9, 0.1}, {0, 1}}, 0.5), 0.0);
}

TEST(LinkQuality, best_threshold_maximises_f1) {
    const Links links{{0.9, 0.5, 0.4, 0.1}, {1, 0, 1, 0}};
    EXPECT_DOUBLE_EQ(best_f1_threshold(links), 0.4);  // TP 2, FP 1: 0.8
    EXPECT_DOUBLE_EQ(best_f1_threshold(Links{{0.9, 0.2}, {0, 0}}), 0.5);
    EXPECT_DOUBLE_EQ(best_f1_threshold(Links{{0.9, 0.2}, {1, 0}}), 0.9);
}

TEST(LinkQuality, log_loss_by_hand) {
    EXPECT_NEAR(*log_loss(Links{{0.8, 0.25}, {1, 0}}), -(std::log(0.8) + std::log(0.75)) / 2, 1e-15);
    EXPECT_NEAR(*log_loss(Links{{0.5, 0.5, 0.5}, {1, 0, 1}}), std::log(2.0), 1e-15);
}

TEST(LinkQuality, certainty_that_is_wrong_costs_a_finite_loss) {
    EXPECT_NEAR(*log_loss(Links{{0.0}, {1}}), 15.0 * std::log(10.0), 1e-6);
    EXPECT_TRUE(std::isfinite(*log_loss(Links{{1.0}, {0}})));
}

TEST(LinkQuality, brier_score_by_hand) {
    EXPECT_NEAR(*brier_score(Links{{0.8, 0.25, 1.0}, {1, 0, 0}}), (0.04 + 0.0625 + 1.0) / 3.0, 1e-15);
    EXPECT_NEAR(*brier_score(Links{{1.0, 0.0}, {1, 0}}), 0.0, 1e-15);
    EXPECT_FALSE(brier_score(Links{}));
}

TEST(LinkQuality, calibration_error_weighs_bins_by_their_pairs) {
    // Bin of 0.10: mean 0.10, share 1/2, two pairs. Bin of 0.90: mean 0.90, share 1, one pair.
    EXPECT_NEAR(*calibration_error(Links{{0.10, 0.10, 0.90}, {1, 0, 1}}), (2 * 0.4 + 1 * 0.1) / 3, 1e-12);
    EXPECT_NEAR(*calibration_error(Links{{0.5, 0.5}, {1, 0}}), 0.0, 1e-12);
    // The first of the 15 bins ends at 0.0667.
    EXPECT_NEAR(*calibration_error(Links{{0.064, 0.05}, {1, 0}}), (1.0 - 0.114) / 2, 1e-12);
    EXPECT_NEAR(*calibration_error(Links{{0.068, 0.05}, {1, 0}}), (0.932 + 0.05) / 2, 1e-12);
    EXPECT_NEAR(*calibration_error(Links{{1.0, 0.0}, {1, 0}}), 0.0, 1e-12);
    // The last one begins at 0.9333.
    EXPECT_NEAR(*calibration_error(Links{{0.9, 1.0}, {1, 0}}), (0.1 + 1.0) / 2, 1e-12);
}

TEST(LinkQuality, one_class_has_no_area) {
    const LinkQuality only_true = link_quality(Links{{0.9, 0.2}, {1, 1}});
    EXPECT_FALSE(only_true.auc);
    EXPECT_DOUBLE_EQ(*only_true.ap, 1.0);
    const LinkQuality only_false = link_quality(Links{{0.4, 0.2}, {0, 0}});
    EXPECT_FALSE(only_false.auc);
    EXPECT_FALSE(only_false.ap);
    EXPECT_FALSE(only_false.f1);
    EXPECT_TRUE(only_false.log_loss);
}

TEST(LinkQuality, no_pairs_have_no_quality) {
    const LinkQuality none = link_quality(Links{});
    EXPECT_EQ(none.pairs, 0U);
    EXPECT_FALSE(none.auc || none.ap || none.f1 || none.log_loss || none.ece);
}

TEST(LinkQuality, a_field_for_every_number) {
    const LinkQuality quality = link_quality(Links{{0.9, 0.7, 0.6, 0.2}, {1, 0, 1, 0}}, 0.65);
    std::vector<std::string> names;
    core::for_each_field<LinkQuality>([&](const auto& field) { names.emplace_back(field.name); });
    EXPECT_THAT(names, testing::ElementsAre("pairs", "true_links", "auc", "ap", "f1", "log_loss", "ece",
                                            "threshold"));
    EXPECT_EQ(quality.pairs, 4U);
    EXPECT_EQ(quality.true_links, 2U);
    EXPECT_DOUBLE_EQ(quality.threshold, 0.65);
    EXPECT_DOUBLE_EQ(*quality.f1, 0.5);
}

}  // namespace
}  // namespace clearway::metrics
