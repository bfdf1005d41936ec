// A run folder over several commands: plans, interruptions, what extends a study and what is another one.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

class ContinuedStudyTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
    }

    std::size_t complete_runs(const std::string& out) const {
        std::size_t count = 0;
        const std::filesystem::path runs = folder() / out / "runs";
        std::error_code ignored;
        for (auto entry = std::filesystem::recursive_directory_iterator(runs, ignored);
             entry != std::filesystem::recursive_directory_iterator(); entry.increment(ignored)) {
            // A run that is being written lies in a folder with a dot in front.
            const bool is_whole = entry->path().parent_path().filename().string().front() != '.';
            if (is_whole && entry->path().filename() == "run.json") ++count;
        }
        return count;
    }
    /// Starts ten replications, interrupts them once a run is complete, and checks what is left.
    void interrupt_and_resume(int signal, int expected_code) const;
};

TEST_F(ContinuedStudyTest, folders_may_be_named_with_a_slash_at_their_end) {
    const Ended ended =
        clearway({"run", "line", "--seeds", "1", "--no-solo", "--policy", "corridor", "--out", "out/"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(complete_runs("out"), 2U);
    const Ended merged = clearway({"study", "merge", "out/", "--out", "all/"});
    ASSERT_EQ(merged.code, 0) << merged.err;
    EXPECT_EQ(complete_runs("all"), 2U);
    EXPECT_EQ(clearway({"report", "all/"}).code, 0);
    EXPECT_EQ(clearway({"export", "figures", "all/", "--out", "figures/", "--svg-only"}).code, 0);
}

TEST_F(ContinuedStudyTest, another_study_in_the_same_folder_is_refused) {
    ASSERT_EQ(clearway(two_conditions("out", 1)).code, 0);
    const std::string before = read("out/runs.csv");
    std::vector<std::string> words = two_conditions("out", 1);
    words.insert(words.end(), {"--seed", "9", "--density", "2"});
    const Ended other = clearway(words);
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err,
                AllOf(HasSubstr("out"), HasSubstr("different seed, scenarios"), HasSubstr("--out")));
    EXPECT_EQ(read("out/runs.csv"), before);
}

TEST_F(ContinuedStudyTest, more_seeds_extend_a_study_and_keep_its_runs) {
    ASSERT_EQ(clearway(two_conditions("out", 2)).code, 0);
    const auto made = std::filesystem::last_write_time(folder() / "out/runs/line/baseline/00001/run.json");
    EXPECT_THAT(clearway({"verify", "out", "--all"}).out, HasSubstr("4 verified: 4 same"));
    const Ended extended = clearway(two_conditions("out", 4));
    ASSERT_EQ(extended.code, 0) << extended.err;
    EXPECT_THAT(extended.err, AllOf(HasSubstr("extended from 2 to 4 replications"), HasSubstr("8/8")));
    EXPECT_THAT(extended.out, HasSubstr("line: 4 replications"));
    EXPECT_EQ(std::filesystem::last_write_time(folder() / "out/runs/line/baseline/00001/run.json"), made);
    EXPECT_THAT(read("out/command.txt"), HasSubstr("--seeds 4"));
    ASSERT_EQ(clearway(two_conditions("whole", 4)).code, 0);
    EXPECT_EQ(read("out/runs.csv"), read("whole/runs.csv"));
    EXPECT_EQ(read("out/vehicles.csv"), read("whole/vehicles.csv"));
}

TEST_F(ContinuedStudyTest, fewer_seeds_than_are_there_are_refused_with_what_to_do) {
    ASSERT_EQ(clearway(two_conditions("out", 2)).code, 0);
    const std::string before = read("out/manifest.json");
    const Ended fewer = clearway(two_conditions("out", 1));
    EXPECT_EQ(fewer.code, 3);
    EXPECT_THAT(fewer.err, AllOf(HasSubstr("holds 2 replications of this study, and 1 are asked for"),
                                 HasSubstr("allowed: 2 or more"), HasSubstr("--out")));
    EXPECT_EQ(read("out/manifest.json"), before);
}

TEST_F(ContinuedStudyTest, a_study_file_with_more_replications_goes_on_in_its_folder) {
    const auto study = [](int replications) {
        return "name = \"mine\"\nreplications = " + std::to_string(replications) +
               "\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n";
    };
    write("my.toml", study(1));
    ASSERT_EQ(clearway({"study", "my.toml"}).code, 0);
    write("my.toml", study(3));
    EXPECT_THAT(clearway({"study", "my.toml", "--dry-run"}).out, HasSubstr("1 complete in runs/mine"));
    const Ended extended = clearway({"study", "my.toml"});
    ASSERT_EQ(extended.code, 0) << extended.err;
    EXPECT_THAT(read("runs/mine/runs.csv"), HasSubstr("line,baseline,2,ok"));
}

TEST_F(ContinuedStudyTest, a_study_with_a_changed_condition_takes_over_the_runs_of_the_others) {
    const auto study = [](const char* policy) {
        return fmt::format(
            "name = \"mine\"\nreplications = 2\nscenarios = [\"./line\"]\n"
            "conditions = [\"baseline\"]\n[[condition]]\nname = \"mine\"\npolicy = \"{}\"\n[titles]\nmine = "
            "\"Ours\"\n",
            policy);
    };
    write("my.toml", study("clear_lane"));
    ASSERT_EQ(clearway({"study", "my.toml"}).code, 0);
    EXPECT_EQ(read("runs/mine/study.toml"), read("my.toml"));
    EXPECT_THAT(read("runs/mine/report.html"), HasSubstr("policy = &quot;clear_lane&quot;"));
    write("my.toml", study("corridor"));
    EXPECT_THAT(clearway({"study", "my.toml"}).err,
                AllOf(HasSubstr("different conditions (Ours: "), HasSubstr("--reuse runs/mine")));
    const Ended planned = clearway({"study", "my.toml", "--dry-run"});
    EXPECT_EQ(planned.code, clearway({"study", "my.toml"}).code);
    EXPECT_THAT(planned.err, HasSubstr("holds another study: different conditions (Ours: "));
    EXPECT_THAT(planned.out, HasSubstr("0 complete in runs/mine")) << "the plan is shown all the same";
    const Ended refused = clearway({"study", "my.toml", "--out", "runs/new", "--reuse", "nowhere"});
    EXPECT_EQ(refused.code, 3) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs/new/manifest.json"));
    const Ended dry =
        clearway({"study", "my.toml", "--out", "runs/new", "--reuse", "runs/mine", "--dry-run"});
    EXPECT_THAT(dry.out,
                testing::ContainsRegex("0 complete in runs/new, 2 taken[ \n]+over from[ \n]+runs/mine"));
    const nlohmann::json plan = nlohmann::json::parse(
        clearway({"study", "my.toml", "--out", "runs/new", "--reuse", "runs/mine", "--dry-run", "--json"})
            .out);
    const nlohmann::json alone =
        nlohmann::json::parse(clearway({"study", "my.toml", "--out", "runs/new", "--dry-run", "--json"}).out);
    EXPECT_EQ(plan["reused_runs"], 2);
    EXPECT_LT(plan["estimated_time_left_s"], alone["estimated_time_left_s"]);
    const Ended ended = clearway({"study", "my.toml", "--out", "runs/new", "--reuse", "runs/mine"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("2 runs taken over from runs/mine; not those of mine, which differ"));
    ASSERT_EQ(clearway({"study", "my.toml", "--out", "runs/whole"}).code, 0);
    EXPECT_EQ(read("runs/new/runs.csv"), read("runs/whole/runs.csv"));
    EXPECT_THAT(clearway({"verify", "runs/new", "--all"}).out, HasSubstr("4 verified: 4 same"));
}

TEST_F(ContinuedStudyTest, a_study_runs_on_another_scenario_than_its_own) {
    write("my.toml",
          "name = \"mine\"\nreplications = 1\nscenarios = [\"merge\"]\nconditions = [\"baseline\", "
          "\"corridor\"]\n"
          "[[condition]]\nname = \"still\"\npolicy = [\"clear_lane\"]\n[controls]\nstill = \"corridor\"\n");
    const Ended ended = clearway({"study", "my.toml", "--scenario", "./line", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto told = nlohmann::json::parse(ended.out)["scenarios"][0];
    EXPECT_EQ(told["name"], "line");
    EXPECT_EQ(told["conditions"][2]["control_of"], "corridor");
    EXPECT_EQ(told["conditions"][1]["controls"][0]["name"], "still");
    EXPECT_TRUE(std::filesystem::exists(folder() / "runs/mine-line/controls.json"));
    EXPECT_THAT(clearway({"study", "my.toml", "--scenario", "./lin"}).err, HasSubstr("./lin"));
}

void ContinuedStudyTest::interrupt_and_resume(int signal, int expected_code) const {
    const int seeds = 10;
    const core::Child child = start(two_conditions("out", seeds));
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (complete_runs("out") == 0 && std::chrono::steady_clock::now() < patience) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ::kill(child.pid, signal);
    const Ended interrupted = finish(child);
    EXPECT_EQ(interrupted.code, expected_code) << interrupted.err;
    EXPECT_THAT(interrupted.err,
                AllOf(testing::ContainsRegex("To continue:\n.*\n.*about [0-9]+:[0-9:]+ is left\n"),
                      HasSubstr("clearway run line")));
    const std::size_t kept = complete_runs("out");
    EXPECT_GE(kept, 1U);
    ASSERT_LT(kept, 2U * seeds);

    const Ended incomplete = clearway({"report", "out"});
    EXPECT_EQ(incomplete.code, 5) << incomplete.err;
    const Ended resumed = clearway(two_conditions("out", seeds));
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    ASSERT_EQ(clearway(two_conditions("undisturbed", seeds, 2)).code, 0);
    EXPECT_EQ(read("out/runs.csv"), read("undisturbed/runs.csv"));
    EXPECT_EQ(read("out/vehicles.csv"), read("undisturbed/vehicles.csv"));
}

TEST_F(ContinuedStudyTest, interrupted_before_its_first_run_it_says_so_and_how_to_continue) {
    write("slow.py",
          "import pathlib, time\npathlib.Path(__file__).with_name('begun').touch()\ntime.sleep(60)\n");
    for (const auto& [signal, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}}) {
        std::filesystem::remove(folder() / "begun");
        const core::Child child = start({"run", "line", "--policy", "slow.py:Slow", "--out", "out"});
        const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!std::filesystem::exists(folder() / "begun") && std::chrono::steady_clock::now() < patience)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ::kill(child.pid, signal);
        const Ended interrupted = finish(child);
        EXPECT_EQ(interrupted.code, code);
        EXPECT_EQ(
            interrupted.err,
            "clearway: interrupted while no run was under way; nothing is lost. To continue:\n  clearway "
            "run line --policy slow.py:Slow --out out\n");
    }
}

TEST_F(ContinuedStudyTest, interrupted_it_exits_with_130_and_continues_to_the_same_result) {
    interrupt_and_resume(SIGINT, 130);
}

TEST_F(ContinuedStudyTest, terminated_it_exits_with_143_and_continues_to_the_same_result) {
    interrupt_and_resume(SIGTERM, 143);
}

TEST_F(ContinuedStudyTest, its_plan_can_be_seen_before) {
    const Ended plan = clearway({"run", "./line", "--seeds", "2", "--dry-run", "--json"});
    ASSERT_EQ(plan.code, 0) << plan.err;
    const auto json = nlohmann::json::parse(plan.out);
    EXPECT_EQ(json.at("runs"), 6) << "baseline, corridor and solo";
    EXPECT_GT(json.at("estimated_time_left_s"), 0.0);
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs"));
    EXPECT_NE(clearway({"run", "./line", "--dry-run", "--gui"}).code, 0);
}

TEST_F(ContinuedStudyTest, a_study_file_runs_and_its_plan_can_be_seen_before) {
    write("my.toml",
          "name = \"mine\"\nreplications = 2\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n"
          "[[condition]]\nname = \"b20\"\nfailure = \"B20\"\npolicy = [\"dissertation\"]\n"
          "safety_checks = \"off\"\n");
    const Ended plan = clearway({"study", "my.toml", "--dry-run", "--json"});
    ASSERT_EQ(plan.code, 0) << plan.err;
    const auto json = nlohmann::json::parse(plan.out);
    EXPECT_EQ(json.at("runs"), 4);
    EXPECT_EQ(json.at("cells").at(1).at("safety_checks"), "off");
    EXPECT_GT(json.at("estimated_time_left_s"), 0.0);
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs"));

    const Ended ended = clearway({"study", "my.toml"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(read("runs/mine/runs.csv"), HasSubstr("line,b20,1,ok"));
    EXPECT_THAT(clearway({"study", "my.toml", "--dry-run"}).out, HasSubstr("4 complete in runs/mine"));
    EXPECT_THAT(clearway({"study", "my.toml", "--dry-run"}).out,
                HasSubstr("policy dissertation, safety checks off (!)"));
    EXPECT_THAT(clearway({"study", "status", "runs/mine"}).out, HasSubstr("b20 (!)"));
}

TEST_F(ContinuedStudyTest, a_condition_that_is_added_to_a_study_keeps_the_runs_of_the_others) {
    const auto study = [](const char* more) {
        return fmt::format(
            "name = \"mine\"\nreplications = 2\nscenarios = [\"./line\"]\nconditions = [\"baseline\", "
            "{}\"corridor\"]\n",
            more);
    };
    write("my.toml", study(""));
    ASSERT_EQ(clearway({"study", "my.toml"}).code, 0);
    const auto made =
        std::filesystem::last_write_time(folder() / "runs/mine/runs/line/corridor/00001/run.json");
    write("my.toml", study("\"graph_simulation\", "));
    const Ended extended = clearway({"study", "my.toml"});
    ASSERT_EQ(extended.code, 0) << extended.err;
    EXPECT_THAT(extended.err, AllOf(HasSubstr("extended from 2 to 3 conditions"), HasSubstr("6/6"),
                                    HasSubstr("--out NEW --reuse runs/mine")));
    EXPECT_EQ(std::filesystem::last_write_time(folder() / "runs/mine/runs/line/corridor/00001/run.json"),
              made);
    ASSERT_EQ(clearway({"study", "my.toml", "--out", "whole"}).code, 0);
    for (const char* const table : {"runs.csv", "vehicles.csv"})
        EXPECT_EQ(read(std::string("runs/mine/") + table), read(std::string("whole/") + table));
    EXPECT_THAT(clearway({"verify", "runs/mine", "--all"}).out, HasSubstr("6 verified: 6 same"));
    write("my.toml", study(""));
    EXPECT_THAT(clearway({"study", "my.toml"}).err,
                HasSubstr("Graph made by simulation attributes is not asked for"));
    write("my.toml", study("\"b10_no_repair\", \"b10_dead_reckoning\", \"solo\", "));
    EXPECT_THAT(clearway({"study", "my.toml"}).err,
                HasSubstr("different conditions (Graph made by simulation attributes is not asked for)"));
    write("my.toml", "seed = 2\n" + study("\"graph_simulation\", \"b10_no_repair\", "));
    EXPECT_THAT(clearway({"study", "my.toml"}).err, HasSubstr("holds another study: different seed. Choose"));
}

TEST_F(ContinuedStudyTest, a_dry_run_refuses_the_folder_that_the_study_would_refuse) {
    const auto study = [](int seed) {
        return "name = \"mine\"\nreplications = 1\nseed = " + std::to_string(seed) +
               "\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n";
    };
    write("my.toml", study(1));
    ASSERT_EQ(clearway({"study", "my.toml"}).code, 0);
    write("my.toml", study(2));
    const Ended dry = clearway({"study", "my.toml", "--dry-run"});
    EXPECT_EQ(dry.code, 3);
    EXPECT_THAT(dry.err, HasSubstr("runs/mine: holds another study"));
    EXPECT_EQ(dry.err, clearway({"study", "my.toml"}).err);
    write("theirs/letter.txt", "mine");
    const Ended foreign = clearway({"study", "my.toml", "--dry-run", "--out", "theirs"});
    EXPECT_EQ(foreign.code, 3);
    EXPECT_THAT(foreign.err, HasSubstr("theirs holds something else"));
}

TEST_F(ContinuedStudyTest, a_damaged_neighbour_is_nothing_to_a_study) {
    ASSERT_EQ(clearway(two_conditions("runs/theirs", 1)).code, 0);
    for (const char* const condition : {"baseline", "graph_simulation"})
        write(fmt::format("runs/theirs/runs/line/{}/00000/timing.json", condition), "{");
    const Ended planned = clearway({"run", "line", "--seeds", "1", "--dry-run", "--out", "runs/mine"});
    EXPECT_EQ(planned.code, 0) << planned.err;
    const Ended ended = clearway(two_conditions("runs/mine", 1));
    EXPECT_EQ(ended.code, 0) << ended.err;
}

}  // namespace
}  // namespace clearway::cli
