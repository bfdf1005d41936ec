// The scripts of a submission when a cluster behaves badly. A Slurm that is real: tests/cluster/slurm.sh.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "user.hpp"

namespace clearway::cli {
namespace {

constexpr int replications = 20;
constexpr int runs = 2 * replications;

/// Shell functions of the scripts below.
constexpr const char* helpers = R"(set -u
mkdir -p bin && export PATH="$PWD/bin:$PATH" SLURM_ARRAY_TASK_ID=1 SLURM_ARRAY_JOB_ID=7
printf '#!/bin/sh\necho "$@" >>%s/requeued\n' "$PWD" >bin/scontrol && chmod +x bin/scontrol
runs() { find "$@" -name run.json | wc -l; }
until_runs() { for _ in $(seq 1200); do [[ $(runs sub/shards) -ge $1 ]] && return; sleep 0.05; done; exit 99; }
)";

class SubmissionTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
        write("my.toml",
              "replications = " + std::to_string(replications) +
                  "\nscenarios = [\"./line\"]\nconditions = [\"baseline\", \"graph_simulation\"]\n");
        const Ended ended =
            clearway({"study", "submit", "my.toml", "--engine", "slurm", "--shards", "1", "--out", "sub"});
        ASSERT_EQ(ended.code, 0) << ended.err;
    }
    /// Runs a script of bash in the folder; its exit code.
    int bash(const std::string& text) const {
        write("script", helpers + text);
        const int status =
            std::system(("cd '" + folder().string() + "' && bash script >script.log 2>&1").c_str());
        return WEXITSTATUS(status);
    }
    nlohmann::json merged() const {
        const Ended ended = clearway({"study", "merge", "sub", "--out", "sub/merged", "--json"});
        EXPECT_EQ(ended.code, 0) << ended.err;
        return nlohmann::json::parse(ended.out);
    }
};

TEST_F(SubmissionTest, a_shard_near_its_time_limit_closes_its_files_and_is_queued_again) {
    ASSERT_EQ(bash("bash sub/array.sbatch & job=$!\n"
                   "until_runs 4\n"
                   "kill -TERM $job; wait $job; code=$?\n"
                   "runs sub/shards >kept\n"
                   "exit $code\n"),
              143)
        << read("script.log") << read("sub/logs/shard-1.log");
    EXPECT_EQ(read("requeued"), "requeue 7_1\n");
    EXPECT_LT(std::stoi(read("kept")), runs) << "the shard was over before it was told";
    ASSERT_EQ(bash("bash sub/array.sbatch"), 0) << read("sub/logs/shard-1.log");
    EXPECT_EQ(read("requeued"), "requeue 7_1\n") << "a shard that ends well is not queued again";
    EXPECT_EQ(merged().at("complete_runs"), runs);
}

TEST_F(SubmissionTest, a_node_declared_dead_that_holds_the_folder_is_worked_beside) {
    ASSERT_EQ(bash("setsid bash sub/shard.sh 1 & dead=$!\n"
                   "until_runs 4\n"
                   "kill -STOP -- -$dead\n"
                   "SLURM_RESTART_COUNT=1 bash sub/shard.sh 1; code=$?\n"
                   "kill -KILL -- -$dead\n"
                   "exit $code\n"),
              0)
        << read("script.log") << read("sub/logs/shard-1.log");
    EXPECT_THAT(read("sub/logs/shard-1.log"), HasSubstr("another command works in this folder"));
    const nlohmann::json result = merged();
    EXPECT_EQ(result.at("complete_runs"), runs);
    EXPECT_GE(result.at("runs_seen_before"), 4);
}

TEST_F(SubmissionTest, a_shard_that_refuses_its_input_is_named_and_nothing_is_merged) {
    write("small.toml", "replications = 1\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n");
    write("other.toml", "seed = 9\n" + read("small.toml"));
    ASSERT_EQ(clearway({"study", "other.toml", "--out", "other"}).code, 0);
    for (const std::string engine : {"slurm", "local", "parallel"}) {
        if (engine == "parallel" && std::system("command -v parallel >/dev/null") != 0) continue;
        ASSERT_EQ(
            clearway({"study", "submit", "small.toml", "--engine", engine, "--shards", "1", "--out", engine})
                .code,
            0);
        // Somebody's runs come there between the submission and the start of its shards.
        const std::string start =
            engine == "slurm" ? "bash slurm/array.sbatch; bash slurm/merge.sbatch" : "bash $engine/submit.sh";
        EXPECT_EQ(
            bash("engine=" + engine + "\nmkdir $engine/shards\ncp -r other $engine/shards/1-of-1\n" + start),
            3)
            << engine;
        EXPECT_THAT(read("script.log"),
                    AllOf(HasSubstr("shard 1 of 1 ended with exit code 3: see "),
                          HasSubstr(engine + "/logs/shard-1.log"), HasSubstr("nothing is merged")));
        EXPECT_THAT(read(engine + "/logs/shard-1.log"), HasSubstr("holds another study"));
        EXPECT_FALSE(std::filesystem::exists(folder() / engine / "merged")) << engine;
    }
}

TEST_F(SubmissionTest, the_merge_hands_on_the_worst_code_of_shards_that_refused_their_input) {
    ASSERT_EQ(
        clearway({"study", "submit", "my.toml", "--engine", "slurm", "--shards", "3", "--out", "three"}).code,
        0);
    EXPECT_EQ(bash("mkdir -p three/logs; cd three/logs\n"
                   "echo 3 >shard-1.exit; echo 7 >shard-2.exit; echo 2 >shard-3.exit\n"
                   "bash ../merge.sbatch"),
              7);
    for (const char* const named :
         {"shard 1 of 3 ended with exit code 3", "shard 2 of 3 ended with exit code 7",
          "shard 3 of 3 ended with exit code 2"})
        EXPECT_THAT(read("script.log"), HasSubstr(named));
}

TEST_F(SubmissionTest, a_shard_with_failed_runs_is_merged) {
    EXPECT_EQ(bash("bash sub/shard.sh 1 && echo 1 >sub/logs/shard-1.exit && bash sub/merge.sbatch"), 0)
        << read("script.log");
    EXPECT_THAT(read("script.log"), HasSubstr(std::to_string(runs) + " runs complete"));
}

TEST_F(SubmissionTest, the_codes_of_an_earlier_call_do_not_count) {
    EXPECT_EQ(bash("printf '#!/bin/sh\\necho 7\\n' >bin/sbatch && chmod +x bin/sbatch\n"
                   "mkdir -p sub/logs; echo 3 >sub/logs/shard-1.exit\n"
                   "bash sub/submit.sh"),
              0)
        << read("script.log");
    EXPECT_FALSE(std::filesystem::exists(folder() / "sub/logs/shard-1.exit"));
}

TEST_F(SubmissionTest, works_in_a_folder_whose_name_a_shell_would_read_otherwise) {
    write("small.toml", "replications = 1\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n");
    const std::string out = "it's $my #1";
    ASSERT_EQ(
        clearway({"study", "submit", "small.toml", "--engine", "slurm", "--shards", "1", "--out", out}).code,
        0);
    EXPECT_THAT(read(out + "/array.sbatch"),
                AllOf(HasSubstr("#SBATCH --output=\"/"), HasSubstr("/" + out + "/logs/slurm-%a.log\"\n")));
    EXPECT_EQ(bash("bash it*/array.sbatch && bash it*/merge.sbatch"), 0) << read("script.log");
    EXPECT_THAT(read("script.log"), HasSubstr("1 run complete"));
}

TEST_F(SubmissionTest, is_refused_in_a_folder_that_sbatch_cannot_be_told) {
    for (const std::string out : {"a\"b", "a%b", "a\\b", "a\nb"}) {
        const Ended ended =
            clearway({"study", "submit", "my.toml", "--engine", "slurm", "--shards", "1", "--out", out});
        EXPECT_EQ(ended.code, 3) << out;
        EXPECT_THAT(ended.err, AllOf(HasSubstr("cannot be written in an option of sbatch"),
                                     HasSubstr("Choose another folder")))
            << out;
        EXPECT_FALSE(std::filesystem::exists(folder() / out)) << out;
    }
    EXPECT_EQ(
        clearway({"study", "submit", "my.toml", "--engine", "local", "--shards", "1", "--out", "a%b"}).code,
        0);
}

}  // namespace
}  // namespace clearway::cli
