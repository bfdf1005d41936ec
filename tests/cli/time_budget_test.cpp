// `clearway run --within`: as many seeds as a time allows.
#include <string>

#include <nlohmann/json.hpp>

#include "user.hpp"

namespace clearway::cli {
namespace {

class TimeBudgetTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
    }

    std::uint32_t replications() const {
        return nlohmann::json::parse(read("out/manifest.json")).at("replications");
    }
};

TEST_F(TimeBudgetTest, a_time_in_place_of_seeds_makes_as_many_as_it_allows_and_says_how_many) {
    const Ended ended = clearway({"run", "line", "--no-solo", "--within", "15s", "--out", "out"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_GT(replications(), 5U);
    const std::string seeds = "--seeds " + std::to_string(replications());
    EXPECT_THAT(ended.err, AllOf(HasSubstr("of 0:15 (m:s) given"), HasSubstr(seeds)));
    // The report's command gives the same runs on a faster machine, too.
    EXPECT_THAT(read("out/command.txt"), AllOf(HasSubstr(seeds), Not(HasSubstr("--within"))));
    const std::uint32_t before = replications();
    ASSERT_EQ(clearway({"run", "line", "--no-solo", "--within", "4s", "--out", "out"}).code, 0);
    EXPECT_GT(replications(), before) << "a folder that is complete gets more";
}

TEST_F(TimeBudgetTest, a_time_that_is_too_short_gives_the_fewest_seeds_with_an_interval) {
    const Ended ended = clearway(
        {"run", "intersection", "--dense", "--no-solo", "--within", "1s", "--out", "out", "--jobs", "1"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(replications(), 5U);
    EXPECT_THAT(ended.err, testing::ContainsRegex("the least, 5 replications of each condition, takes about "
                                                  ".*, more than the 0:01 \\(m:s\\) given"));
}

TEST_F(TimeBudgetTest, runs_that_fail_do_not_count_as_a_pace) {
    const Ended ended = clearway(
        {"run", "city", "--no-solo", "--within", "30s", "--run-time-limit", "0.001", "--out", "out"});
    EXPECT_EQ(ended.code, 1) << ended.err;
    EXPECT_EQ(replications(), 5U) << "no round follows one in which nothing was made";
}

TEST_F(TimeBudgetTest, a_plan_says_how_many_seeds_a_time_allows) {
    const auto planned = [&](const std::string& time) -> std::uint32_t {
        const Ended ended = clearway({"run", "line", "--within", time, "--dry-run", "--json"});
        EXPECT_EQ(ended.code, 0) << ended.err;
        return nlohmann::json::parse(ended.out).at("replications");
    };
    EXPECT_EQ(planned("1s"), 5U);
    const std::uint32_t of_a_minute = planned("1min");
    EXPECT_GT(of_a_minute, 5U);
    EXPECT_NEAR(planned("2min"), 2.0 * of_a_minute, 4.0);
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs"));
}

TEST_F(TimeBudgetTest, what_is_no_time_or_comes_with_seeds_is_refused) {
    for (const char* const time : {"10", "min", "-5min", "0s", "10 minutes", "1001h", "1e3s", "nan s"}) {
        const Ended ended = clearway({"run", "line", "--within", time});
        EXPECT_EQ(ended.code, 2) << time;
        EXPECT_THAT(ended.err, AllOf(HasSubstr("--within"), HasSubstr("10min"))) << time;
    }
    const Ended both = clearway({"run", "line", "--within", "1min", "--seeds", "4"});
    EXPECT_EQ(both.code, 2);
    EXPECT_THAT(both.err, AllOf(HasSubstr("--within"), HasSubstr("--seeds")));
}

}  // namespace
}  // namespace clearway::cli
