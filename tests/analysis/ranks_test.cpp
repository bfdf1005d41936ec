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

TEST(Wilcoxon, AgreesWithStudentsSleepDataDespiteTiesAndAZero) {
    // R: wilcox.test(paired = TRUE, exact = FALSE): V = 0, p 0.009091
    EXPECT_NEAR(*wilcoxon_p(first_drug, second_drug), 0.009091, 5e-7);
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
    const std::vector<double> zeros(25, 0.0);
    const double exact = *wilcoxon_p(values, zeros);
    values.push_back(0.0);  // A zero is left out, but forces the approximation.
    const double approximate = *wilcoxon_p(values, std::vector<double>(26, 0.0));
    EXPECT_NE(exact, approximate);
    EXPECT_NEAR(exact, approximate, 0.003);
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
