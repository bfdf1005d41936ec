#include <utility>

#include <gmock/gmock.h>

#include "analysis/estimate.hpp"
#include "analysis/worked_examples.hpp"

namespace clearway::analysis {
namespace {

using namespace examples;

TEST(Wilcoxon, AgreesWithHollanderAndWolfe) {
    // V = 40, one-sided p 0.01953 (R's help page): 10 of 512 subsets.
    EXPECT_DOUBLE_EQ(*wilcoxon_p(first_visit, second_visit), 20.0 / 512.0);
    EXPECT_DOUBLE_EQ(*wilcoxon_p(second_visit, first_visit), 20.0 / 512.0);
}

TEST(Wilcoxon, IsExactForStudentsSleepDataDespiteTiesAndAZero) {
    // V = 0 of nine that are not zero: 1 of 512 subsets on each side, as exactRankTests::wilcox.exact counts.
    EXPECT_DOUBLE_EQ(*wilcoxon_p(first_drug, second_drug), 2.0 / 512.0);
}

TEST(Wilcoxon, CountsTiesExactly) {
    // Ranks 1.5, 1.5, 3 and 4, of which 1.5 and 3 are positive: 8 of the 16 sums are 4.5 or less.
    EXPECT_DOUBLE_EQ(*wilcoxon_p(std::vector{1.0, -1.0, 2.0, -3.0}, std::vector<double>(4, 0.0)), 1.0);
    // 1.5 alone is: 3 of 16 are 1.5 or less.
    EXPECT_DOUBLE_EQ(*wilcoxon_p(std::vector{1.0, -1.0, -2.0, -3.0}, std::vector<double>(4, 0.0)), 0.375);
}

TEST(Wilcoxon, CountsExactlyWhatCanBeCountedByHand) {
    // All three differences positive: 1 of 8 subsets on each side.
    EXPECT_DOUBLE_EQ(*wilcoxon_p(std::vector{1.0, 2.0, 3.0}, std::vector{0.0, 0.0, 0.0}), 0.25);
    EXPECT_DOUBLE_EQ(*wilcoxon_p(std::vector{-1.0, -2.0, 3.0}, std::vector{0.0, 0.0, 0.0}), 1.0);
    EXPECT_FALSE(wilcoxon_p(std::vector{1.0, 2.0}, std::vector{1.0, 2.0}));
}

TEST(Wilcoxon, ExactAndNormalAgreeWhereOneTakesOver) {
    std::vector<double> values;
    for (int row = 1; row <= 25; ++row)
        values.push_back(row % 3 == 0 ? -row : row);
    const auto p = [&] { return *wilcoxon_p(values, std::vector<double>(values.size(), 0.0)); };
    const double exact = p();
    values.push_back(0.0);
    EXPECT_EQ(p(), exact) << "a zero is left out";
    // V = 243 of 351: z = (243 - 175.5 - 0.5) / sqrt(1550.25) = 1.7017, by the normal table 0.0888.
    values.back() = 26.0;
    EXPECT_NEAR(p(), 0.088818, 5e-6);
}

TEST(Wilcoxon, CorrectsTheNormalApproximationForTies) {
    // scipy.stats.wilcoxon(values, correction=True, mode="approx")
    std::vector<double> values;
    for (const auto& [value, count] :
         {std::pair{1.0, 20}, std::pair{-1.0, 8}, std::pair{2.0, 7}, std::pair{-2.0, 3}})
        values.insert(values.end(), static_cast<std::size_t>(count), value);
    EXPECT_NEAR(*wilcoxon_p(values, std::vector<double>(values.size(), 0.0)), 0.01892343582, 1e-10);
}

TEST(Holm, AdjustsAsInTheTextbookExample) {
    // p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm") of R.
    const std::vector<double> p_values = {0.01, 0.04, 0.03, 0.005};
    EXPECT_THAT(holm(p_values),
                testing::ElementsAre(testing::DoubleNear(0.03, 1e-15), testing::DoubleNear(0.06, 1e-15),
                                     testing::DoubleNear(0.06, 1e-15), testing::DoubleNear(0.02, 1e-15)));
    EXPECT_THAT(holm(std::vector{0.8, 0.9}), testing::ElementsAre(1.0, 1.0));
    EXPECT_TRUE(holm({}).empty());
}

}  // namespace
}  // namespace clearway::analysis
