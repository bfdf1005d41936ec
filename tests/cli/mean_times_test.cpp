// Mean times of other days: written, named by a scenario, used, and refused.
#include <chrono>
#include <thread>

#include "crossings.hpp"

namespace clearway::cli {
namespace {

class MeanTimesTest : public CrossingsTest {
  protected:
    Ended make(const std::string& file) const { return clearway(order(file)); }
    static std::vector<std::string> order(const std::string& file) {
        return {"scenario", "mean-times", "./crossings", "--out", file, "--seeds", "2", "--jobs", "1"};
    }
    Ended run(const std::string& out, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"run",       "./crossings",
                                          "--policy",  "navigate",
                                          "--set",     "navigate.prior=mean_times",
                                          "--seeds",   "1",
                                          "--no-solo", "--record",
                                          "--name",    "mine",
                                          "--out",     out};
        words.insert(words.end(), more.begin(), more.end());
        return clearway(words);
    }
};

TEST_F(MeanTimesTest, are_made_on_other_days_and_used_by_a_run_and_its_replay) {
    const Ended made = make("crossings/mean.csv");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(made.out,
                AllOf(HasSubstr("from 2 runs with study seed 77"), HasSubstr("mean_times = \"mean.csv\"")));
    EXPECT_THAT(read("crossings/mean.csv"),
                AllOf(testing::StartsWith("# clearway mean times 1: network "), HasSubstr("\nA_B,16,")));
    EXPECT_EQ(make("crossings/mean.csv").code, 3) << "never over a file";
    std::filesystem::create_directory(folder() / "tmp");
    const core::Child late = start(order("late.csv"), {.environment = {{"TMPDIR", folder() / "tmp"}}});
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::filesystem::is_empty(folder() / "tmp") && std::chrono::steady_clock::now() < patience)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    write("late.csv", "made meanwhile");
    EXPECT_EQ(finish(late).code, 3);
    EXPECT_EQ(read("late.csv"), "made meanwhile");
    write_scenario("B_east", "mean_times = \"mean.csv\"\n");
    const Ended done = run("out");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(read("out/scenarios/crossings/mean.csv"), read("crossings/mean.csv"));
    const Ended again = clearway({"replay", "out/crossings/mine/0"});
    EXPECT_EQ(again.code, 0) << again.out << again.err;
    const Ended own_future = run("other", {"--seed", "77"});
    EXPECT_EQ(own_future.code, 3);
    EXPECT_THAT(own_future.err, HasSubstr("was made with study seed 77, which is that of this study"));
    std::string text = read("crossings/mean.csv");
    text.replace(text.find("A_B,16,") + 7, 1, "9");
    write("crossings/mean.csv", text);
    const Ended changed = run("out");
    EXPECT_EQ(changed.code, 3) << "other times, another study";
    EXPECT_THAT(changed.err, HasSubstr("holds another study"));
}

TEST_F(MeanTimesTest, have_to_be_named_by_the_scenario_and_to_be_of_its_network) {
    const Ended none = run("out");
    EXPECT_EQ(none.code, 3);
    EXPECT_THAT(none.err, AllOf(HasSubstr("navigate.prior"), HasSubstr("the scenario names none"),
                                HasSubstr("clearway scenario mean-times")));
    write("crossings/mean.csv",
          "# clearway mean times 1: network abc, study seed 77, runs 1, edges 1\n"
          "edge,vehicles,time_s\nA_B,5,9\n");
    write_scenario("B_east", "mean_times = \"mean.csv\"\n");
    const Ended foreign = run("out");
    EXPECT_EQ(foreign.code, 3);
    EXPECT_THAT(foreign.err, HasSubstr("holds times of network abc"));
}

}  // namespace
}  // namespace clearway::cli
