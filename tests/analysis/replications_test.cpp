#include "analysis/replications.hpp"

#include <gmock/gmock.h>

#include "analysis/headline.hpp"
#include "results/synthetic.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::analysis {
namespace {

// t(n - 1) at 0.975 from printed tables: 2.262 for 9, 2.228 for 10, 2.201 for 11, 2.045 for 29 degrees of
// freedom.
TEST(RequiredReplications, AreTheLeastThatFulfilFhwasEquation) {
    // s / e = 1.5: 11 runs give (2.228 * 1.5)^2 = 11.17 > 11; 12 runs give (2.201 * 1.5)^2 = 10.90 <= 12.
    EXPECT_EQ(required_replications(1.5, 1.0), 12U);
    // s / e = 1.4: 10 runs give (2.262 * 1.4)^2 = 10.03 > 10; 11 runs (2.228 * 1.4)^2 = 9.73 <= 11.
    EXPECT_EQ(required_replications(7.0, 5.0), 11U);
}

TEST(RequiredReplications, ApproachTheNormalLawAndNeverFallBelowTwo) {
    EXPECT_EQ(required_replications(0.0, 1.0), 2U);
    // (1.96 * 50)^2 = 9604; a t of 9603 degrees of freedom is larger by 0.02 %.
    EXPECT_NEAR(static_cast<double>(required_replications(50.0, 1.0)), 9607.0, 3.0);
}

TEST(RequiredReplications, EndWhereNoNumberOfRunsTells) {
    EXPECT_EQ(required_replications(50.0, 1e-16), most_replications);
    EXPECT_EQ(replications_to_show(50.0, 1e-16), most_replications);
}

TEST(RequiredReplications, GiveTheHalfWidthThatWasAskedForAndOneLessDoesNot) {
    const double deviation = 3.7;
    const double half_width = 1.1;
    const std::size_t n = required_replications(deviation, half_width);
    std::vector<double> values;
    const auto half_width_of = [&](std::size_t count) {
        // Values with exactly this deviation: half of them above, half below.
        values.clear();
        for (std::size_t i = 0; i < count; ++i)
            values.push_back(i % 2 == 0 ? 1.0 : -1.0);
        const auto estimate = *estimate_mean(values);
        return estimate.interval->half_width() * deviation / estimate.deviation;
    };
    EXPECT_LE(half_width_of(n), half_width);
    EXPECT_GT(half_width_of(n - 1), half_width);
}

class HeadlineOfAStudy : public testing::Test {
  protected:
    void write(const std::string& condition, std::uint32_t replication, double travel_time_s) {
        store_.write(results::synthetic::record({"alpha", condition, replication}, travel_time_s), {});
    }
    support::TemporaryFolder folder_;
    results::Store store_ = results::Store::create(folder_.path() / "out", results::synthetic::manifest(4));
};

TEST_F(HeadlineOfAStudy, IsThePairedDifferenceOfWhatIsThere) {
    Headline headline(store_);
    headline.refresh();
    EXPECT_EQ(headline.text(), "");
    write("baseline", 0, 50.0);
    write("treated", 0, 47.0);
    write("treated", 1, 12.0);  // no pair yet
    headline.refresh();
    EXPECT_EQ(headline.text(), "EV travel time -3.0 s, n 1: alpha treated");
    write("baseline", 1, 13.0);
    headline.refresh();
    headline.refresh();
    ASSERT_TRUE(headline.estimate());
    EXPECT_EQ(headline.estimate()->n, 2U);
    EXPECT_DOUBLE_EQ(headline.estimate()->mean, -2.0);
    // Differences -3 and -1: deviation sqrt(2), half width 12.706 * sqrt(2) / sqrt(2); too few to print.
    EXPECT_NEAR(headline.estimate()->interval->high, 10.7, 0.05);
    EXPECT_EQ(headline.text(), "EV travel time -2.0 s, n 2: alpha treated");
    Headline titled(store_, {{"treated", "Ours, B10"}});
    titled.refresh();
    EXPECT_EQ(titled.text(), "EV travel time -2.0 s, n 2: alpha Ours, B10");
}

TEST_F(HeadlineOfAStudy, TellsWhichConditionNeedsMost) {
    const double treated[] = {47.0, 44.0, 49.0, 43.0};
    for (std::uint32_t replication = 0; replication < 4; ++replication) {
        write("baseline", replication, 50.0);
        write("treated", replication, treated[replication]);
    }
    const auto found = widest(summarise(results::read_results(store_)), "emergency_travel_time_s", 1.0);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->scenario, "alpha");
    EXPECT_EQ(found->condition, "treated");
    EXPECT_EQ(found->n, 4U);
    // s^2 = 7.583; t(31) = 2.040, n = 32: 31.5 <= 32, and t(30) = 2.042, n = 31: 31.6 > 31.
    EXPECT_EQ(found->required, 32U);
    EXPECT_EQ(found->lost, 0U);
}

}  // namespace
}  // namespace clearway::analysis
