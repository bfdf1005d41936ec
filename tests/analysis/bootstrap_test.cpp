#include <cmath>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>

#include "analysis/estimate.hpp"
#include "analysis/worked_examples.hpp"

namespace clearway::analysis {
namespace {

using examples::spatial_a;

RowStatistic mean_of(const std::vector<double>& values) {
    return [&values](std::span<const std::size_t> rows) {
        double sum = 0.0;
        for (const std::size_t row : rows)
            sum += values[row];
        return sum / static_cast<double>(rows.size());
    };
}

/// The biased variance, equation (14.2) of Efron and Tibshirani 1993.
double variance(std::span<const std::size_t> rows) {
    const double mean = mean_of(spatial_a)(rows);
    double sum = 0.0;
    for (const std::size_t row : rows)
        sum += (spatial_a[row] - mean) * (spatial_a[row] - mean);
    return sum / static_cast<double>(rows.size());
}

TEST(BootstrapBca, AgreesWithEfronAndTibshirani) {
    // Table 14.2: observed 171.5; 90 % BCa interval (115.8, 259.6) from 2000 resamples.
    std::vector<std::size_t> all(spatial_a.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    ASSERT_NEAR(variance(all), 171.5, 0.05);
    BootstrapConfig config;
    config.resamples = 20000;
    config.level = 0.90;
    config.small_sample = SmallSample::as_published;
    const auto interval = bootstrap_bca(spatial_a.size(), variance, config);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, 115.8, 3.0);
    EXPECT_NEAR(interval->high, 259.6, 6.0);
}

TEST(BootstrapBca, IsCloseToTheTIntervalForASymmetricMean) {
    std::vector<double> values;
    for (int row = -20; row <= 20; ++row)
        values.push_back(row);
    const auto interval = bootstrap_bca(values.size(), mean_of(values));
    const auto estimate = estimate_mean(values);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, estimate->interval->low, 0.35);
    EXPECT_NEAR(interval->high, estimate->interval->high, 0.35);
}

TEST(BootstrapBca, RepeatsWithItsSeedAndMovesWithAnother) {
    const auto first = bootstrap_bca(spatial_a.size(), variance);
    const auto again = bootstrap_bca(spatial_a.size(), variance);
    BootstrapConfig other;
    other.seed = 2;
    const auto moved = bootstrap_bca(spatial_a.size(), variance, other);
    EXPECT_EQ(first->low, again->low);
    EXPECT_NE(first->low, moved->low);
}

TEST(BootstrapBca, IsWiderWhenSmallSamplesAreMadeUpFor) {
    BootstrapConfig published;
    published.small_sample = SmallSample::as_published;
    const auto narrow = bootstrap_bca(spatial_a.size(), variance, published);
    const auto wide = bootstrap_bca(spatial_a.size(), variance);
    EXPECT_LT(wide->low, narrow->low);
    EXPECT_GT(wide->high, narrow->high);
}

TEST(BootstrapBca, SaysNothingWhereNothingCanBeSaid) {
    const std::vector<double> same = {2.0, 2.0, 2.0, 2.0};
    EXPECT_FALSE(bootstrap_bca(same.size(), mean_of(same)));
    EXPECT_FALSE(bootstrap_bca(2, mean_of(same)));
    EXPECT_FALSE(bootstrap_bca(4, [](std::span<const std::size_t> rows) {
        return rows[0] == 0 ? std::numeric_limits<double>::infinity() : 1.0;
    }));
}

TEST(GapClosed, IsTheShareOfTheWayFromBaselineToSolo) {
    const std::vector<double> baseline = {100.0, 120.0, 140.0, 110.0};
    const std::vector<double> solo = {60.0, 60.0, 80.0, 70.0};
    const std::vector<double> condition = {80.0, 100.0, 105.0, 85.0};
    const auto gap = gap_closed(condition, baseline, solo);
    ASSERT_TRUE(gap && gap->interval);
    EXPECT_DOUBLE_EQ(gap->value, (470.0 - 370.0) / (470.0 - 270.0));
    EXPECT_TRUE(gap->interval->contains(gap->value));
    EXPECT_DOUBLE_EQ(gap_closed(solo, baseline, solo)->value, 1.0);
    EXPECT_DOUBLE_EQ(gap_closed(baseline, baseline, solo)->value, 0.0);
}

TEST(GapClosed, NeedsAGap) {
    const std::vector<double> times = {60.0, 70.0, 80.0};
    EXPECT_FALSE(gap_closed(times, times, times));
    EXPECT_FALSE(gap_closed({}, {}, {}));
}

}  // namespace
}  // namespace clearway::analysis
