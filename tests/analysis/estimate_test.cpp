#include "analysis/estimate.hpp"

#include <gmock/gmock.h>

#include "analysis/worked_examples.hpp"

namespace clearway::analysis {
namespace {

using namespace examples;

TEST(EstimateDifference, AgreesWithStudentsSleepData) {
    // R: t.test(extra ~ group, data = sleep, paired = TRUE)
    const auto estimate = estimate_difference(first_drug, second_drug);
    ASSERT_TRUE(estimate && estimate->interval);
    EXPECT_EQ(estimate->n, 10U);
    EXPECT_NEAR(estimate->mean, -1.58, 1e-12);
    EXPECT_NEAR(estimate->interval->low, -2.4598858, 1e-7);
    EXPECT_NEAR(estimate->interval->high, -0.7001142, 1e-7);
    EXPECT_NEAR(*paired_t_p(first_drug, second_drug), 0.002833, 5e-7);
    EXPECT_NEAR(*effect_size(first_drug, second_drug), -4.062128 / std::sqrt(10.0), 1e-6);
}

TEST(EstimateMean, AgreesWithFishersMaize) {
    // Fisher 1935: mean 20.933, t 2.148 on 14 degrees of freedom, 5 % point 2.145.
    const auto estimate = estimate_mean(maize);
    ASSERT_TRUE(estimate && estimate->interval);
    EXPECT_NEAR(estimate->mean, 20.933, 5e-4);
    EXPECT_NEAR(estimate->mean / (estimate->deviation / std::sqrt(15.0)), 2.148, 5e-4);
    EXPECT_NEAR(estimate->interval->half_width(), 2.1448 * estimate->deviation / std::sqrt(15.0), 1e-3);
    EXPECT_GT(estimate->interval->low, 0.0) << "significant at 5 %, if narrowly";
    EXPECT_LT(estimate_mean(maize, 0.99)->interval->low, 0.0);
}

TEST(EstimateMean, HasNoIntervalForOneValueAndNothingForNone) {
    EXPECT_FALSE(estimate_mean({}));
    const auto one = estimate_mean(std::vector{3.0});
    EXPECT_DOUBLE_EQ(one->mean, 3.0);
    EXPECT_FALSE(one->interval);
}

TEST(RelativeDifference, IsTheDifferenceOverTheBaselinesMean) {
    const std::vector<double> baseline = {100.0, 120.0, 140.0};
    const std::vector<double> condition = {80.0, 90.0, 130.0};
    const auto difference = estimate_difference(condition, baseline);
    const auto relative = relative_difference(condition, baseline);
    EXPECT_NEAR(relative->mean, -20.0 / 120.0, 1e-12);
    EXPECT_NEAR(relative->interval->high, difference->interval->high / 120.0, 1e-12);
    EXPECT_FALSE(relative_difference(std::vector{1.0, 2.0}, std::vector{0.0, 0.0}));
}

TEST(Quantile, InterpolatesAsTypeSevenOfHyndmanAndFan) {
    // numpy.percentile([15, 20, 35, 40, 50], 40) = 29
    const std::vector<double> values = {40.0, 15.0, 50.0, 35.0, 20.0};
    EXPECT_DOUBLE_EQ(quantile(values, 0.4), 29.0);
    EXPECT_DOUBLE_EQ(quantile(values, 0.0), 15.0);
    EXPECT_DOUBLE_EQ(quantile(values, 1.0), 50.0);
    EXPECT_DOUBLE_EQ(median(values), 35.0);
    EXPECT_DOUBLE_EQ(median(std::vector{1.0, 2.0, 4.0, 9.0}), 3.0);
}

TEST(EffectSize, IsNotDefinedWithoutVariation) {
    EXPECT_FALSE(effect_size(std::vector{2.0, 3.0}, std::vector{1.0, 2.0}));
    EXPECT_FALSE(paired_t_p(std::vector{2.0}, std::vector{1.0}));
}

}  // namespace
}  // namespace clearway::analysis
