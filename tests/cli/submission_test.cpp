// The scripts of a submission when a cluster behaves badly. A Slurm that is real: tests/cluster/slurm.sh.
#include <cstdlib>
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

}  // namespace
}  // namespace clearway::cli
