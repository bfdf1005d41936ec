// Studies in shards, from the command line to the merged files.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <nlohmann/json.hpp>

#include "user.hpp"

namespace clearway::cli {
namespace {

class ShardsTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
        write_study(4);
    }
    void write_study(int replications, const std::string& more = "") const {
        write("my.toml",
              "replications = " + std::to_string(replications) +
                  "\nscenarios = [\"./line\"]\nconditions = [\"baseline\", \"graph_simulation\"]\n" + more);
    }
    Ended shard(const std::string& part, const std::string& out) const {
        return clearway({"study", "my.toml", "--shard", part, "--out", out});
    }
    Ended submit(const std::string& file, const std::string& out) const {
        return clearway({"study", "submit", file, "--shards", "2", "--out", out, "--go"});
    }
    /// The status of a folder once so many of its runs are complete, or after a minute.
    nlohmann::json status_after(const std::string& out, int runs) const {
        nlohmann::json status;
        const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        do {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            const Ended ended = clearway({"study", "status", out, "--json"});
            status = ended.code == 0 ? nlohmann::json::parse(ended.out) : nlohmann::json::object();
        } while (status.value("complete_runs", 0) < runs && std::chrono::steady_clock::now() < patience);
        return status;
    }
    void expect_tables_of_one_machine(const std::string& merged) const {
        ASSERT_EQ(clearway({"study", "my.toml", "--out", "single"}).code, 0);
        for (const char* const table : {"runs.csv", "vehicles.csv", "results.sqlite"})
            EXPECT_EQ(read(merged + "/" + table), read(std::string("single/") + table)) << table;
    }
};

TEST_F(ShardsTest, merge_to_the_bytes_of_one_machine) {
    for (const char* const part : {"1", "2", "3"}) {
        const Ended ended = shard(std::string(part) + "/3", std::string("s/shards/") + part);
        ASSERT_EQ(ended.code, 0) << ended.err;
        EXPECT_THAT(ended.out, HasSubstr(std::string("shard ") + part + "/3: "));
        write(std::string("s/shards/") + part + "/code/0f/mine.py", "# a policy");
    }
    const Ended status = clearway({"study", "status", "s", "--json"});
    EXPECT_EQ(nlohmann::json::parse(status.out).at("state"), "complete");
    EXPECT_EQ(nlohmann::json::parse(status.out).at("complete_runs"), 8);
    const Ended merged = clearway({"study", "merge", "s", "--out", "all", "--json"});
    ASSERT_EQ(merged.code, 0) << merged.err;
    EXPECT_EQ(nlohmann::json::parse(merged.out).at("complete_runs"), 8);
    expect_tables_of_one_machine("all");
    EXPECT_EQ(read("all/code/0f/mine.py"), "# a policy");
    const Ended report = clearway({"report", "all"});
    EXPECT_EQ(report.code, 0) << report.err;
    EXPECT_EQ(report.out, clearway({"report", "single"}).out);
}

TEST_F(ShardsTest, a_merge_that_lacks_a_shard_names_it_and_exits_with_5) {
    ASSERT_EQ(shard("1/2", "one").code, 0);
    const Ended merged = clearway({"study", "merge", "one", "--out", "all"});
    EXPECT_EQ(merged.code, 5);
    EXPECT_THAT(merged.out, AllOf(HasSubstr("not there: shard 2/2"), HasSubstr("missing: line/baseline/1")));
    EXPECT_EQ(clearway({"report", "all"}).code, 5);
}

TEST_F(ShardsTest, a_damaged_record_is_named_and_taken_from_the_shard_that_has_it_whole) {
    ASSERT_EQ(clearway({"study", "my.toml", "--out", "one"}).code, 0);
    ASSERT_EQ(clearway({"study", "my.toml", "--out", "two"}).code, 0);
    const std::string file = "two/runs/line/baseline/00002/run.json";
    std::string text = read(file);
    text.replace(text.find("\"vehicle_count\": "), 18, "\"vehicle_count\": 8");
    write(file, text);
    for (const auto& sources : {std::vector<std::string>{"one", "two"}, {"two", "one"}}) {
        const Ended merged = clearway({"study", "merge", sources[0], sources[1], "--out", "all"});
        EXPECT_EQ(merged.code, 0) << merged.err;
        EXPECT_THAT(merged.err, AllOf(HasSubstr(file), HasSubstr("It is left out")));
        EXPECT_EQ(read("all/runs.csv"), read("one/runs.csv"));
        std::filesystem::remove_all(folder() / "all");
    }
    const Ended lacking = clearway({"study", "merge", "two", "--out", "all"});
    EXPECT_EQ(lacking.code, 5);
    EXPECT_THAT(lacking.out, HasSubstr("missing: line/baseline/2"));
}

TEST_F(ShardsTest, conflicting_shards_are_refused_before_anything_runs) {
    for (const char* const wrong : {"3/2", "0/2", "1/0", "half"}) {
        const Ended ended = shard(wrong, "out");
        EXPECT_EQ(ended.code, 3) << wrong;
        EXPECT_THAT(ended.err, HasSubstr("--shard")) << wrong;
    }
    EXPECT_EQ(clearway({"study", "my.toml", "--shard", "1/2"}).code, 2) << "a shard needs --out";
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    ASSERT_EQ(shard("1/2", "out").code, 0);
    const std::string before = read("out/.shard");
    for (const char* const other : {"1/3", "2/2"}) {
        const Ended ended = shard(other, "out");
        EXPECT_EQ(ended.code, 3) << other;
        EXPECT_THAT(ended.err, HasSubstr("holds shard 1/2"));
    }
    EXPECT_EQ(clearway({"study", "my.toml", "--out", "out"}).code, 3);
    EXPECT_EQ(read("out/.shard"), before);
}

TEST_F(ShardsTest, of_another_study_are_refused) {
    ASSERT_EQ(shard("1/2", "one").code, 0);
    write_study(5);
    ASSERT_EQ(shard("2/2", "two").code, 0);
    const Ended merged = clearway({"study", "merge", "one", "two", "--out", "all"});
    EXPECT_EQ(merged.code, 3);
    EXPECT_THAT(merged.err, HasSubstr("different replications"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "all"));
}

TEST_F(ShardsTest, are_run_and_merged_by_local_processes) {
    const Ended ended = clearway({"study", "submit", "my.toml", "--shards", "3", "--out", "sub", "--go"});
    ASSERT_EQ(ended.code, 0) << ended.err << ended.out;
    EXPECT_THAT(ended.out, AllOf(HasSubstr("8 runs in 3 shards"), HasSubstr("8 runs complete")));
    expect_tables_of_one_machine("sub/merged");
    const Ended other = clearway({"study", "submit", "my.toml", "--shards", "2", "--out", "sub"});
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err, HasSubstr("already divided into 3 shards, not 2"));
    EXPECT_EQ(clearway({"study", "submit", "my.toml", "--shards", "99", "--out", "more"}).code, 3);
    EXPECT_EQ(clearway({"study", "submit", "my.toml", "--shards", "3", "--out", "sub"}).code, 0);
}

TEST_F(ShardsTest, are_not_submitted_into_a_folder_of_somebody_else) {
    std::filesystem::create_directory(folder() / "theirs");
    write("theirs/submit.sh", "sbatch mine");
    const Ended ended = clearway({"study", "submit", "my.toml", "--shards", "2", "--out", "theirs"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("theirs holds something else (allowed: a new or empty folder, or one "
                                     "of clearway study submit)"));
    EXPECT_EQ(read("theirs/submit.sh"), "sbatch mine");
    EXPECT_FALSE(std::filesystem::exists(folder() / "theirs/shards.txt"));
}

TEST_F(ShardsTest, are_not_submitted_into_a_folder_with_a_file_of_our_name) {
    std::filesystem::create_directory(folder() / "theirs");
    write("theirs/shards.txt", "2\n");
    write("theirs/submit.sh", "sbatch mine");
    const Ended ended = clearway({"study", "submit", "my.toml", "--shards", "2", "--out", "theirs"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("theirs holds something else"));
    EXPECT_EQ(read("theirs/submit.sh"), "sbatch mine");
    EXPECT_FALSE(std::filesystem::exists(folder() / "theirs/shard.sh"));
}

TEST_F(ShardsTest, of_another_study_are_not_submitted_beside_those_of_the_first) {
    ASSERT_EQ(submit("my.toml", "sub").code, 0);
    const std::string before = read("sub/shard.sh");
    const std::string table = read("sub/merged/runs.csv");
    write("other.toml", "seed = 9\n" + read("my.toml"));
    const Ended other = submit("other.toml", "sub");
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err, AllOf(HasSubstr("sub/merged: holds another study: different study name, seed"),
                                 HasSubstr("Choose another folder with --out")));
    EXPECT_EQ(read("sub/shard.sh"), before);
    EXPECT_EQ(read("sub/merged/runs.csv"), table);
    // A shard alone tells, too.
    std::filesystem::remove_all(folder() / "sub/merged");
    EXPECT_THAT(submit("other.toml", "sub").err, HasSubstr("sub/shards/1-of-2: holds another study"));
}

TEST_F(ShardsTest, are_submitted_again_to_extend_their_study) {
    write_study(2);
    ASSERT_EQ(submit("my.toml", "sub").code, 0);
    write_study(4);
    const Ended more = submit("my.toml", "sub");
    ASSERT_EQ(more.code, 0) << more.err;
    EXPECT_THAT(more.out, HasSubstr("8 runs complete"));
    expect_tables_of_one_machine("sub/merged");
    write_study(3);
    const Ended fewer = submit("my.toml", "sub");
    EXPECT_EQ(fewer.code, 3);
    EXPECT_THAT(fewer.err, HasSubstr("holds 4 replications of this study, and 3 are asked for"));
}

TEST_F(ShardsTest, are_not_submitted_into_a_folder_that_their_runs_would_refuse) {
    const Ended ended = clearway({"study", "submit", "my.toml", "--shards", "2", "--out", "a,b"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err,
                HasSubstr("a,b: has a comma in its path, which SUMO takes as a separator (allowed: "
                          "a path without commas)"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "a,b"));
}

TEST_F(ShardsTest, are_given_the_path_of_a_study_that_comes_with_clearway) {
    const std::string study = "studies/arterial_failure.toml";
    const Ended ended = clearway({"study", "submit", study, "--shards", "1", "--out", "sub"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(read("sub/shard.sh"),
                AllOf(HasSubstr("/" + study), Not(HasSubstr((folder() / study).string()))));
}

TEST_F(ShardsTest, end_when_their_submission_gets_a_signal) {
    write_study(300);
    for (const std::string engine : {"local", "parallel"}) {
        if (engine == "parallel" && std::system("command -v parallel >/dev/null") != 0) continue;
        const core::Child submission = start(
            {"study", "submit", "my.toml", "--engine", engine, "--shards", "2", "--out", engine, "--go"});
        EXPECT_GE(status_after(engine, 2).value("complete_runs", 0), 2) << engine;
        ::kill(submission.pid, SIGTERM);
        EXPECT_EQ(finish(submission).code, 143) << engine;
        const Ended status = clearway({"study", "status", engine});
        EXPECT_THAT(status.out, AllOf(HasSubstr("stopped"), Not(HasSubstr("running")))) << engine;
        EXPECT_EQ(read(engine + "/logs/shard-1.exit"), "143\n") << "it was killed before it closed its files";
        EXPECT_FALSE(std::filesystem::exists(folder() / engine / "merged")) << engine;
    }
}

TEST_F(ShardsTest, are_run_and_merged_by_gnu_parallel) {
    if (std::system("command -v parallel >/dev/null") != 0)
        GTEST_SKIP() << "package parallel is not installed";
    const Ended ended = clearway(
        {"study", "submit", "my.toml", "--engine", "parallel", "--shards", "2", "--out", "sub", "--go"});
    ASSERT_EQ(ended.code, 0) << ended.err << ended.out;
    expect_tables_of_one_machine("sub/merged");
}

TEST_F(ShardsTest, status_sees_a_study_that_runs_and_one_that_was_killed) {
    write_study(300);
    const core::Child study = start({"study", "my.toml", "--out", "out"});
    const nlohmann::json running = status_after("out", 4);
    EXPECT_EQ(running.at("state"), "running");
    EXPECT_EQ(running.at("runs"), 600);
    EXPECT_GT(running.at("time_left_s"), 0.0);
    EXPECT_EQ(running.at("headline").at("condition"), "graph_simulation");
    ::kill(study.pid, SIGKILL);
    finish(study);
    EXPECT_THAT(clearway({"study", "status", "out"}).out, HasSubstr("out: stopped"));
    EXPECT_EQ(clearway({"study", "status", "line"}).code, 3);
}

TEST_F(ShardsTest, a_precision_target_is_reached_in_rounds_or_stopped_at_its_cap) {
    const std::string target = "[precision]\nmetric = \"waiting_time_s\"\nat_most = 12\nhalf_width = ";
    write("my.toml", "scenarios = [\"./line\"]\nconditions = [\"baseline\", \"graph_simulation\"]\n" +
                         target + "1000\n");
    const Ended easy = clearway({"study", "my.toml", "--out", "easy"});
    ASSERT_EQ(easy.code, 0) << easy.err;
    EXPECT_THAT(easy.err, AllOf(HasSubstr("after 10 replications"), HasSubstr(": reached")));
    EXPECT_THAT(read("easy/runs.csv"), HasSubstr("line,baseline,9,ok"));
    write("my.toml",
          "scenarios = [\"./line\"]\nconditions = [\"baseline\"]\n[precision]\nmetric = "
          "\"emergency_travel_time_s\"\nat_most = 12\nhalf_width = 0.001\n");
    const Ended capped = clearway({"study", "my.toml", "--out", "hard"});
    ASSERT_EQ(capped.code, 0) << capped.err;
    EXPECT_THAT(capped.err, AllOf(HasSubstr("after 12 replications"), HasSubstr("stopped at the cap")));
    EXPECT_THAT(read("hard/runs.csv"), HasSubstr("line,baseline,11,ok"));
    const std::string before = read("hard/runs.csv");
    EXPECT_EQ(clearway({"study", "my.toml", "--out", "hard"}).code, 0);
    EXPECT_EQ(read("hard/runs.csv"), before);
    EXPECT_EQ(shard("1/2", "shard").code, 3);
}

TEST_F(ShardsTest, unknown_parameters_of_failures_are_told_before_anything_runs) {
    write_study(2, "[factors]\nfailure.dark_shar = [0.1]\n");
    const Ended ended = clearway({"study", "my.toml", "--out", "out"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("dark_shar: is unknown"), HasSubstr("Did you mean 'dark_share'?")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(ShardsTest, factors_are_cells_of_the_plan_and_of_the_tables) {
    write("my.toml",
          "replications = 2\nscenarios = [\"./line\"]\nconditions = [\"baseline\", \"b10_no_repair\"]\n"
          "[factors]\nfailure.dark_share = [0.1, 0.5]\nscenario.demand.human = [3, 6]\n");
    const Ended plan = clearway({"study", "my.toml", "--dry-run", "--json"});
    ASSERT_EQ(plan.code, 0) << plan.err;
    EXPECT_EQ(nlohmann::json::parse(plan.out).at("runs"), 2 * 2 * 3);
    EXPECT_GT(nlohmann::json::parse(plan.out).at("estimated_disk_left_bytes"), 0.0);
    ASSERT_EQ(clearway({"study", "my.toml", "--out", "out"}).code, 0);
    EXPECT_THAT(read("out/runs.csv"), HasSubstr("line+human=6,b10_no_repair+dark_share=0.5,1,ok"));
}

}  // namespace
}  // namespace clearway::cli
