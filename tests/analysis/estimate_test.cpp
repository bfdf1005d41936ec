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

TEST(EstimateAdjusted, OfALineIsTheMeanOfTheLineOverTheLargerSample) {
    const std::vector<double> covariate = {1.0, 4.0, 2.0, 7.0, 3.0};
    const std::vector<double> all = {1.0, 4.0, 2.0, 7.0, 3.0, 9.0, 8.0, 5.0};
    const auto on_line = [](std::vector<double> values) {
        for (double& value : values)
            value = 10.0 - 0.5 * value;
        return values;
    };
    const auto adjusted = estimate_adjusted(on_line(covariate), covariate, all);
    const auto larger = estimate_mean(on_line(all));
    ASSERT_TRUE(adjusted && adjusted->interval);
    EXPECT_EQ(adjusted->n, 5U);
    EXPECT_NEAR(adjusted->mean, larger->mean, 1e-12);
    EXPECT_NEAR(adjusted->interval->low, larger->interval->low, 1e-9);
    EXPECT_NEAR(adjusted->interval->high, larger->interval->high, 1e-9);
    EXPECT_NEAR(adjusted->deviation, 0.0, 1e-12);
}

TEST(EstimateAdjusted, WhereTheMeanIsCertainIsALineOfRegressionThere) {
    // By hand: y = 2.2 + 0.6 x, squares of residuals 2.4, t 3.1824 on 3 degrees of freedom.
    const std::vector<double> values = {2.0, 4.0, 5.0, 4.0, 5.0};
    const auto adjusted =
        estimate_adjusted(values, std::vector{1.0, 2.0, 3.0, 4.0, 5.0}, std::vector<double>(9, 4.0));
    EXPECT_NEAR(adjusted->mean, 4.6, 1e-12);
    EXPECT_NEAR(adjusted->deviation, std::sqrt(0.8), 1e-12);
    EXPECT_NEAR(adjusted->interval->half_width(), 3.1824 * std::sqrt(0.8 * (0.2 + 0.1)), 1e-4);
}

TEST(EstimateAdjusted, IsNothingForFewPairsOrAConstantCovariate) {
    const std::vector<double> same(5, 2.0);
    const std::vector<double> values = {1.0, 2.0, 3.0, 4.0, 5.0};
    EXPECT_FALSE(estimate_adjusted(values, same, same));
    EXPECT_FALSE(estimate_adjusted(std::vector{1.0, 2.0, 3.0, 4.0}, std::vector{1.0, 2.0, 3.0, 5.0}, values));
}

TEST(EstimateRatio, OfClustersOfOneSizeIsTheMeanOfTheirMeans) {
    const std::vector<double> sums = {2.0, 8.0, 0.0, 5.0};
    const auto ratio = estimate_ratio(sums, std::vector{2.0, 2.0, 0.0, 2.0});
    const auto mean = estimate_mean(std::vector{1.0, 4.0, 2.5});
    EXPECT_EQ(ratio->n, 3U) << "an empty cluster says nothing";
    EXPECT_DOUBLE_EQ(ratio->mean, mean->mean);
    EXPECT_DOUBLE_EQ(ratio->interval->low, mean->interval->low);
    EXPECT_FALSE(estimate_ratio(std::vector{0.0}, std::vector{0.0}));
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
    EXPECT_DOUBLE_EQ(quantile(values, 0.9), 46.0);
    EXPECT_DOUBLE_EQ(quantile(values, 1.0), 50.0);
    EXPECT_DOUBLE_EQ(median(values), 35.0);
    EXPECT_DOUBLE_EQ(median(std::vector{1.0, 2.0, 4.0, 9.0}), 3.0);
}

TEST(EffectSize, IsNotDefinedWithoutVariation) {
    EXPECT_FALSE(effect_size(std::vector{2.0, 3.0}, std::vector{1.0, 2.0}));
    EXPECT_FALSE(paired_t_p(std::vector{2.0}, std::vector{1.0}));
    EXPECT_NEAR(*effect_size(std::vector{0.2, 0.4}, std::vector{0.0, 0.0}), 0.3 / (0.2 / std::sqrt(2.0)),
                1e-9);
}

TEST(QuantileInterval, OfAMedianInterpolatesAsHettmanspergerAndSheather) {
    // n = 10: 2 of 10 order statistics in from each end hold 97.85 %, 3 hold 89.06 %. I = (0.97852 - 0.95) /
    // (0.97852 - 0.89062) = 0.3244; weight 8 I / (2 + 6 I) = 0.6577 between them.
    std::vector<double> values = {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0};
    const auto interval = quantile_interval(values, 0.5);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, 2.0 + 0.6577 * 2.0, 1e-3);
    EXPECT_NEAR(interval->high, 256.0 - 0.6577 * 128.0, 1e-1);
}

TEST(QuantileInterval, NeedsEnoughValuesToBoundTheQuantile) {
    const std::vector<double> values(72, 1.0);
    EXPECT_FALSE(quantile_interval(std::span(values).first(5), 0.5));
    EXPECT_TRUE(quantile_interval(std::span(values).first(6), 0.5));
    EXPECT_FALSE(quantile_interval(std::span(values).first(71), 0.95));
    EXPECT_TRUE(quantile_interval(values, 0.95));
    EXPECT_FALSE(quantile_interval({}, 0.5));
}

TEST(EstimateCount, AgreesWithGarwoodsTable) {
    // Exact 95 % limits of a Poisson count of 10: 4.795 and 18.390; of 0: 0 and 3.689.
    const std::vector<double> ten = {2.0, 2.0, 2.0, 2.0, 2.0};
    EXPECT_NEAR(estimate_count(ten)->interval->low * 5.0, 4.795, 5e-4);
    EXPECT_NEAR(estimate_count(ten)->interval->high * 5.0, 18.390, 5e-4);
    const std::vector<double> none(5, 0.0);
    EXPECT_EQ(estimate_count(none)->interval->low, 0.0);
    EXPECT_NEAR(estimate_count(none)->interval->high * 5.0, 3.689, 5e-4);
    EXPECT_FALSE(estimate_count(std::vector{3.0})->interval);
}

TEST(EstimateCount, IsWiderWhereCountsScatterMoreThanChance) {
    const std::vector<double> even = {2.0, 2.0, 2.0, 2.0, 2.0};
    const std::vector<double> uneven = {0.0, 0.0, 0.0, 0.0, 10.0};
    EXPECT_GT(estimate_count(uneven)->interval->high, 2.0 * estimate_count(even)->interval->high);
    // Dispersion 10, total 1; t(4) at 0.025 is -2.7764, beyond which 0.00275 of a normal distribution lie.
    EXPECT_NEAR(estimate_count(uneven)->interval->low, 0.005503, 5e-6);
    EXPECT_NEAR(estimate_count(uneven)->interval->high, 16.2117, 5e-4);
}

TEST(EstimateCountDifference, DoesNotTakeFourRareEventsForCertain) {
    std::vector<double> some(20, 0.0);
    std::fill_n(some.begin(), 4, 1.0);
    const std::vector<double> none(20, 0.0);
    EXPECT_GT(estimate_difference(some, none)->interval->low, 0.0) << "the t interval does";
    EXPECT_TRUE(estimate_count_difference(some, none)->interval->contains(0.0));
    std::fill_n(some.begin(), 12, 1.0);
    EXPECT_GT(estimate_count_difference(some, none)->interval->low, 0.0);
    EXPECT_TRUE(estimate_count_difference(none, none)->interval->contains(0.1)) << "never seen is not never";
    const std::vector<double> one_run = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0};
    const std::vector<double> same_run = {0, 0, 0, 0, 0, 5, 0, 0, 0, 0};
    EXPECT_TRUE(estimate_count_difference(one_run, same_run)->interval->contains(0.0)) << "one pair alone";
    EXPECT_TRUE(estimate_count_difference(same_run, one_run)->interval->contains(0.0));
}

TEST(EstimateCountDifference, HasTheLimitsOfZouAndDonner) {
    const std::vector<double> more = {2.0, 4.0, 6.0, 8.0, 5.0};
    const std::vector<double> less = {1.0, 2.0, 3.0, 6.0, 3.0};
    const double together = 16.0 / std::sqrt(20.0 * 14.0);  // Pearson's correlation.
    const auto limit_away = [&](double first, double second) {
        return std::sqrt(first * first + second * second - 2.0 * together * first * second);
    };
    const Interval of_more = *estimate_count(more)->interval;
    const Interval of_less = *estimate_count(less)->interval;
    const auto difference = estimate_count_difference(more, less);
    EXPECT_NEAR(difference->interval->low, 2.0 - limit_away(5.0 - of_more.low, of_less.high - 3.0), 1e-9);
    EXPECT_NEAR(difference->interval->high, 2.0 + limit_away(of_more.high - 5.0, 3.0 - of_less.low), 1e-9);
}

TEST(EstimateCountDifference, TakesCountsThatNeverVaryForIndependentOfOthers) {
    const std::vector<double> varying = {1.0, 2.0, 3.0, 6.0};
    const std::vector<double> same(4, 2.0);
    const Interval of_varying = *estimate_count(varying)->interval;
    const Interval of_same = *estimate_count(same)->interval;
    const auto difference = estimate_count_difference(varying, same);
    EXPECT_NEAR(difference->interval->low, 1.0 - std::hypot(3.0 - of_varying.low, of_same.high - 2.0), 1e-9);
    EXPECT_NEAR(difference->interval->high, 1.0 + std::hypot(of_varying.high - 3.0, 2.0 - of_same.low), 1e-9);
}

TEST(Geh, AgreesWithTheWorkedExample) {
    // Modelled 1200, counted 1000 vehicles an hour: sqrt(2 * 200^2 / 2200) = 6.03.
    EXPECT_NEAR(geh(1200.0, 1000.0), 6.03, 5e-3);
    EXPECT_DOUBLE_EQ(geh(1000.0, 1200.0), geh(1200.0, 1000.0));
    EXPECT_EQ(geh(0.0, 0.0), 0.0);
    EXPECT_LT(geh(1100.0, 1000.0), geh_limit);
}

TEST(RequiredReplications, AreTheFewestWhoseIntervalIsNarrowEnough) {
    // s = 10, half width 3: n = 46 has t(45) 10 / sqrt(46) = 2.970, n = 45 has 3.004.
    EXPECT_EQ(required_replications(10.0, 3.0), 46U);
    EXPECT_EQ(required_replications(0.1, 3.0), 2U);
    EXPECT_GT(required_replications(10.0, 0.3), 4200U);
}

TEST(ReplicationsToShow, AreThoseOfAPairedTTestOfEightyPercentPower) {
    // Tables of a paired t test, two-sided 0.05: 34 pairs at d = 0.5, 15 at 0.8, 199 at 0.2.
    EXPECT_EQ(replications_to_show(10.0, 5.0), 34U);
    EXPECT_EQ(replications_to_show(10.0, 8.0), 15U);
    EXPECT_EQ(replications_to_show(10.0, 2.0), 199U);
    EXPECT_EQ(replications_to_show(0.0, 2.0), 2U);
}

}  // namespace
}  // namespace clearway::analysis
