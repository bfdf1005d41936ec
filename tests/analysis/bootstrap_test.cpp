#include "analysis/bootstrap.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include <gmock/gmock.h>

#include "analysis/worked_examples.hpp"

namespace clearway::analysis {
namespace {

using examples::spatial_a;

/// The biased variance, equation (14.2) of Efron and Tibshirani 1993.
double variance(RowCounts counts) {
    double n = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t row = 0; row < spatial_a.size(); ++row) {
        n += counts[row];
        sum += counts[row] * spatial_a[row];
        squares += counts[row] * spatial_a[row] * spatial_a[row];
    }
    return squares / n - (sum / n) * (sum / n);
}

Resamples resamples_of(std::size_t rows, std::size_t count = 2000,
                       SmallSample small_sample = SmallSample::expanded, double level = 0.95) {
    BootstrapConfig config;
    config.resamples = count;
    config.small_sample = small_sample;
    config.level = level;
    return Resamples(rows, config);
}

TEST(Resamples, DrawAsManyRowsAsThereAre) {
    const Resamples resamples = resamples_of(13, 50);
    std::set<std::vector<std::uint8_t>> different;
    for (std::size_t number = 0; number < 50; ++number) {
        const RowCounts counts = resamples.counts(number);
        EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 13);
        different.emplace(counts.begin(), counts.end());
    }
    EXPECT_EQ(different.size(), 50U);
}

TEST(BootstrapBca, AgreesWithEfronAndTibshirani) {
    // Table 14.2: observed 171.5; 90 % BCa interval (115.8, 259.6) from 2000 resamples.
    ASSERT_NEAR(variance(std::vector<std::uint8_t>(spatial_a.size(), 1)), 171.5, 0.05);
    const auto interval =
        bootstrap_bca(resamples_of(spatial_a.size(), 20000, SmallSample::as_published, 0.90), variance);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, 115.8, 3.0);
    EXPECT_NEAR(interval->high, 259.6, 6.0);
}

TEST(BootstrapBca, OfMeansIsThatOfTheSameStatisticOverRows) {
    std::vector<double> squares;
    for (const double value : spatial_a)
        squares.push_back(value * value);
    const Resamples resamples = resamples_of(spatial_a.size());
    const std::vector<std::span<const double>> columns = {spatial_a, squares};
    const auto by_means = bootstrap_bca(
        resamples, columns, [](std::span<const double> means) { return means[1] - means[0] * means[0]; });
    const auto by_rows = bootstrap_bca(resamples, variance);
    EXPECT_NEAR(by_means->low, by_rows->low, 1e-8);
    EXPECT_NEAR(by_means->high, by_rows->high, 1e-8);
}

TEST(BootstrapBca, IsCloseToTheTIntervalForASymmetricMean) {
    std::vector<double> values;
    for (int row = -20; row <= 20; ++row)
        values.push_back(row);
    const auto interval = bootstrap_bca_of_mean(resamples_of(values.size()), values);
    const auto estimate = estimate_mean(values);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, estimate->interval->low, 0.35);
    EXPECT_NEAR(interval->high, estimate->interval->high, 0.35);
}

TEST(BootstrapBca, RepeatsWithItsSeedAndMovesWithAnother) {
    const auto first = bootstrap_bca(Resamples(spatial_a.size()), variance);
    const auto again = bootstrap_bca(Resamples(spatial_a.size()), variance);
    BootstrapConfig other;
    other.seed = 2;
    const auto moved = bootstrap_bca(Resamples(spatial_a.size(), other), variance);
    EXPECT_EQ(first->low, again->low);
    EXPECT_NE(first->low, moved->low);
}

TEST(BootstrapBca, IsWiderWhenSmallSamplesAreMadeUpFor) {
    const auto narrow =
        bootstrap_bca(resamples_of(spatial_a.size(), 2000, SmallSample::as_published), variance);
    const auto wide = bootstrap_bca(resamples_of(spatial_a.size()), variance);
    EXPECT_LT(wide->low, narrow->low);
    EXPECT_GT(wide->high, narrow->high);
}

TEST(BootstrapBca, HasNoAccelerationWhereNoRowAloneChangesAnything) {
    // Odd rows minus even rows of those drawn twice or more: 0 in the sample and without any row.
    const auto repeated = [](RowCounts counts) {
        double sum = 0.0;
        for (std::size_t row = 0; row < counts.size(); ++row)
            if (counts[row] >= 2) sum += row % 2 == 0 ? -1.0 : 1.0;
        return sum;
    };
    const auto interval = bootstrap_bca(resamples_of(8), repeated);
    ASSERT_TRUE(interval);
    EXPECT_LT(interval->low, 0.0);
    EXPECT_GT(interval->high, 0.0);
}

TEST(BootstrapBca, TakesAShareThatNoResampleLiesBelowForHalfAResample) {
    // 1 to 10 in the resamples, 0 in the sample and without any row: z0 = -1.64485, the quantile of 0.5 / 10,
    // so that the upper end is the quantile of Phi(2 z0 + 1.95996) = 0.091801, the lower one that of Phi(2 z0
    // - 1.95996).
    double next = 0.0;
    std::size_t asked = 0;
    const auto rising = [&](RowCounts) { return ++asked == 1 || next >= 10.0 ? 0.0 : ++next; };
    const auto interval = bootstrap_bca(resamples_of(8, 10, SmallSample::as_published), rising);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, 1.0, 1e-5);
    EXPECT_NEAR(interval->high, 1.0 + 9.0 * 0.091801, 1e-4);
}

TEST(BootstrapBca, SaysNothingWhereNothingCanBeSaid) {
    const std::vector<double> same = {2.0, 2.0, 2.0, 2.0};
    EXPECT_FALSE(bootstrap_bca_of_mean(resamples_of(4), same));
    EXPECT_FALSE(bootstrap_bca_of_mean(resamples_of(2), std::vector{1.0, 2.0}));
    EXPECT_FALSE(bootstrap_bca(resamples_of(4), [](RowCounts counts) {
        return counts[0] == 0 ? std::numeric_limits<double>::infinity() : 1.0;
    }));
}

TEST(PooledQuantile, CountsMembersWithoutAValueAboveAllOthers) {
    const std::vector<Cluster> clusters = {{{10.0, 30.0}, 0}, {{20.0}, 1}, {{40.0}, 0}, {{50.0}, 0}};
    const Resamples resamples = resamples_of(clusters.size());
    // Ascending: 10 20 30 40 50 and one that did not arrive.
    EXPECT_EQ(pooled_quantile(clusters, 0.5, resamples)->mean, 30.0);
    EXPECT_EQ(pooled_quantile(clusters, 0.5, resamples)->deviation, 0.0) << "it has none";
    EXPECT_EQ(pooled_quantile(clusters, 5.0 / 6.0, resamples)->mean, 50.0);
    EXPECT_FALSE(pooled_quantile(clusters, 0.95, resamples));
}

TEST(GapClosed, IsTheShareOfTheWayFromBaselineToSolo) {
    const std::vector<double> baseline = {100.0, 120.0, 140.0, 110.0};
    const std::vector<double> solo = {60.0, 60.0, 80.0, 70.0};
    const std::vector<double> condition = {80.0, 100.0, 105.0, 85.0};
    const Resamples resamples = resamples_of(baseline.size());
    const auto gap = gap_closed(condition, baseline, solo, resamples);
    ASSERT_TRUE(gap && gap->interval);
    EXPECT_DOUBLE_EQ(gap->mean, (470.0 - 370.0) / (470.0 - 270.0));
    EXPECT_TRUE(gap->interval->contains(gap->mean));
    EXPECT_DOUBLE_EQ(gap_closed(solo, baseline, solo, resamples)->mean, 1.0);
    EXPECT_DOUBLE_EQ(gap_closed(baseline, baseline, solo, resamples)->mean, 0.0);
}

TEST(GapClosed, NeedsAGap) {
    const std::vector<double> times = {60.0, 70.0, 80.0};
    EXPECT_FALSE(gap_closed(times, times, times, resamples_of(3)));
    EXPECT_FALSE(gap_closed({}, {}, {}, resamples_of(0)));
}

}  // namespace
}  // namespace clearway::analysis
