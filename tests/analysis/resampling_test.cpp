#include "analysis/resampling.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>

namespace clearway::analysis {
namespace {

/// 0, 1, ... 1000.
std::vector<double> thousand() {
    std::vector<double> values(1001);
    std::iota(values.begin(), values.end(), 0.0);
    return values;
}

TEST(RunResampling, DrawsAsManyRunsOfEachStratumAsThereAre) {
    const RunResampling resampling({4, 6}, {.resamples = 50});
    EXPECT_EQ(resampling.runs(), 10U);
    for (std::size_t number = 0; number < 50; ++number) {
        const auto weights = resampling.weights(number);
        EXPECT_EQ(std::accumulate(weights.begin(), weights.begin() + 4, 0.0), 4.0);
        EXPECT_EQ(std::accumulate(weights.begin() + 4, weights.end(), 0.0), 6.0);
    }
}

TEST(RunResampling, HasAnIntervalThatIsWiderForFewRuns) {
    // t(8) at 0.025 is -2.306; times sqrt(4 / 3) it is the normal quantile of 0.003875.
    const auto interval = RunResampling({4, 6}).interval(thousand());
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, 3.8753, 0.001);
    EXPECT_NEAR(interval->high, 996.1247, 0.001);
    EXPECT_FALSE(RunResampling({1, 9}).interval(thousand())) << "one run does not vary";
    EXPECT_FALSE(RunResampling({4}).interval(thousand())) << "as in studies";
    EXPECT_TRUE(RunResampling({5}).interval(thousand()));
    EXPECT_FALSE(RunResampling({2, 3}).interval(thousand()));
    EXPECT_TRUE(RunResampling({2, 2, 2, 2}).interval(thousand()));
    EXPECT_FALSE(RunResampling({4, 6}).interval({1.0, std::numeric_limits<double>::infinity()}));
}

TEST(RunResampling, GivesAPThatIsLargerForFewRuns) {
    // 9 of 999 values are not above 0: (9 + 1) / (999 + 1) has the normal quantile -2.3263, and over
    // sqrt(4 / 3) that has twice the tail 0.0787 of t(8).
    std::vector<double> values(999, 1.0);
    std::fill_n(values.begin(), 9, -1.0);
    EXPECT_NEAR(*RunResampling({4, 6}).p(values), 0.0787, 5e-5);
    for (double& value : values)
        value = -value;
    EXPECT_NEAR(*RunResampling({4, 6}).p(values), 0.0787, 5e-5) << "on either side";
    std::ranges::replace(values, 1.0, 0.0);
    EXPECT_NEAR(*RunResampling({4, 6}).p(values), 0.0787, 5e-5) << "0 is on both sides";
    EXPECT_EQ(RunResampling({4, 6}).p(std::vector{-1.0, 1.0}), 1.0);
}

}  // namespace
}  // namespace clearway::analysis
