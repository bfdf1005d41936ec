#include "campaign/workers.hpp"

#include <algorithm>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/files.hpp"
#include "experiment/job.hpp"
#include "results/synthetic.hpp"
#include "results/table_writer.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::campaign {
namespace {

using core::ExitCode;
using experiment::RunKey;
using results::ErrorCause;

class Study : public testing::Test {
  protected:
    /// Two scenarios, these conditions, `replications` seeds.
    void plan(const std::vector<std::string>& conditions, std::uint32_t replications) {
        study::StudyConfig config;
        config.name = "fake";
        config.replications = replications;
        for (const char* name : {"alpha", "beta"})
            config.scenarios.emplace_back().name = name;
        for (const std::string& name : conditions)
            config.conditions.emplace_back().name = name;
        config_ = config;
    }
    study::Plan plan_in(const std::string& folder) const {
        return study::make_plan(config_, {"0.1.0", "1.15.0"}, folder_.path() / folder);
    }
    results::Store store_in(const std::string& folder) const {
        return results::Store::create(folder_.path() / folder, plan_in(folder).manifest);
    }
    /// Whether a worker starts when the study is continued.
    bool continues_in(const std::string& folder, RetriedRuns retried) {
        const auto logs = store_in(folder).folder() / "logs";
        std::filesystem::remove_all(logs);
        options_.retried = retried;
        run_in(folder);
        return !std::filesystem::is_empty(logs);
    }
    StudyResult run_in(const std::string& folder, unsigned workers = 2) {
        options_.workers = workers;
        return run_units(plan_in(folder), store_in(folder), options_,
                         [this](const StudyProgress& progress) { reported_.push_back(progress); });
    }
    /// All final bytes of a run folder.
    std::string tables_of(const std::string& folder) const {
        const results::Store store = store_in(folder);
        results::write_tables(store);
        std::string all;
        for (const char* file : {"runs.csv", "vehicles.csv", "results.sqlite"})
            all += core::read_file(store.folder() / file);
        return all;
    }
    /// The study in a process of its own.
    pid_t fork_study(const std::string& folder) {
        const pid_t child = fork();
        if (child == 0) _exit(static_cast<int>(run_in(folder).exit_code));
        return child;
    }
    void wait_for(const results::Store& store, const RunKey& key) const {
        while (!store.complete(key))
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }

    support::TemporaryFolder folder_;
    study::StudyConfig config_;
    WorkersOptions options_{.worker_program = std::string(CLEARWAY_BINARY_DIR) + "/tests/fake_worker",
                            .limits = {.wall_s = 60.0},
                            .termination_grace_s = 0.2};
    std::vector<StudyProgress> reported_;
};

TEST_F(Study, CompletesEveryRunAndReportsHowFarItIs) {
    plan({"baseline", "treated"}, 3);
    const StudyResult result = run_in("out");
    EXPECT_EQ(result.exit_code, ExitCode::ok);
    EXPECT_EQ(result.progress.done, 12U);
    EXPECT_DOUBLE_EQ(result.progress.work, 1.0);
    for (std::size_t i = 1; i < reported_.size(); ++i)
        EXPECT_LE(reported_[i].work, 1.0);
    EXPECT_EQ(result.progress.total, 12U);
    EXPECT_EQ(results::read_results(store_in("out")).runs.size(), 12U);
    ASSERT_FALSE(reported_.empty());
    EXPECT_EQ(reported_.back().done, 12U);
    EXPECT_TRUE(std::ranges::is_sorted(reported_, {}, &StudyProgress::done));
}

TEST_F(Study, GivesTheSameBytesForOneAndTwoWorkers) {
    plan({"baseline", "slow", "refused"}, 3);
    run_in("one", 1);
    run_in("two", 2);
    EXPECT_EQ(tables_of("one"), tables_of("two"));
}

TEST_F(Study, KeepsWhatACrashedWorkerFinishedAndTriesTheRestAgain) {
    plan({"baseline", "crash_once", "treated"}, 2);
    const StudyResult result = run_in("out");
    EXPECT_EQ(result.exit_code, ExitCode::ok);
    EXPECT_EQ(result.progress.done, 12U);
    const auto second_log = core::read_file(store_in("out").log_file("alpha-00000-standard.2"));
    EXPECT_THAT(second_log, testing::Not(testing::HasSubstr("baseline")));
    EXPECT_THAT(second_log, testing::HasSubstr("alpha/crash_once/0"));
}

TEST_F(Study, RecordsACrashAfterThreeAttemptsAndGoesOn) {
    plan({"baseline", "crash"}, 2);
    const StudyResult result = run_in("out");
    EXPECT_EQ(result.exit_code, ExitCode::runs_failed);
    EXPECT_EQ(result.progress.done, 4U);
    EXPECT_EQ(result.progress.failed, 4U);
    const auto failure = store_in("out").read_error({"beta", "crash", 1});
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->cause, ErrorCause::signal);
    EXPECT_EQ(failure->signal, SIGSEGV);
    EXPECT_EQ(failure->attempts, 3);
    EXPECT_THAT(failure->log_tail, testing::HasSubstr("run beta/crash/1"));
}

TEST_F(Study, EndsAWorkerAtItsTimeLimit) {
    plan({"baseline", "hang"}, 1);
    options_.limits.wall_s = 0.5;
    options_.attempts = 2;
    const StudyResult result = run_in("out");
    EXPECT_EQ(result.exit_code, ExitCode::runs_failed);
    const auto failure = store_in("out").read_error({"alpha", "hang", 0});
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->cause, ErrorCause::time_limit);
    EXPECT_EQ(failure->attempts, 2);
    EXPECT_TRUE(store_in("out").complete({"alpha", "baseline", 0}));
}

TEST_F(Study, EndsAWorkerThatNeedsTooMuchMemoryAndDoesNotTryItAgain) {
    plan({"baseline", "hog"}, 1);
    options_.limits.memory_mib = 128;
    EXPECT_EQ(run_in("out").exit_code, ExitCode::runs_failed);
    const auto failure = store_in("out").read_error({"beta", "hog", 0});
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->cause, ErrorCause::memory);
    EXPECT_EQ(failure->attempts, 1);
    EXPECT_THAT(failure->message, testing::HasSubstr("128 MiB"));
    EXPECT_TRUE(store_in("out").complete({"beta", "baseline", 0}));
}

TEST_F(Study, TriesAgainWhatAWorkerTellsOfACrashButNotOfMemory) {
    plan({"baseline", "told_crash", "told_memory"}, 1);
    EXPECT_EQ(run_in("out").exit_code, ExitCode::runs_failed);
    const results::Store store = store_in("out");
    const auto crash = store.read_error({"alpha", "told_crash", 0});
    ASSERT_TRUE(crash);
    EXPECT_EQ(crash->attempts, 3);
    EXPECT_EQ(crash->command, "clearway-run it");
    EXPECT_THAT(crash->log_tail, testing::HasSubstr("run alpha/told_crash/0"));
    const auto third_log = core::read_file(store.log_file("alpha-00000-standard.3"));
    EXPECT_THAT(third_log, testing::Not(testing::HasSubstr("told_memory")));
    EXPECT_EQ(store.read_error({"alpha", "told_memory", 0})->attempts, 1);
}

TEST_F(Study, TellsHowToMakeACrashAgain) {
    plan({"baseline", "crash"}, 1);
    run_in("out");
    const auto failure = store_in("out").read_error({"alpha", "crash", 0});
    ASSERT_TRUE(failure);
    const results::Store store = store_in("out");
    const auto unit = store.unit_file("alpha-00000-standard");
    EXPECT_EQ(failure->command, options_.worker_program.string() + " " + unit.string());
    EXPECT_EQ(std::get<experiment::RunJob>(experiment::read_job(unit)).conditions.at(0).name, "crash");
    EXPECT_NE(std::system((failure->command + " > /dev/null").c_str()), 0);
}

TEST_F(Study, NeverTriesBadInputAndRefusedRunsAgain) {
    plan({"baseline", "refused", "forgetful", "bad_input"}, 1);
    EXPECT_EQ(run_in("out").exit_code, ExitCode::runs_failed);
    const results::Store store = store_in("out");
    EXPECT_EQ(store.read_error({"alpha", "bad_input", 0})->cause, ErrorCause::bad_input);
    EXPECT_EQ(store.read_error({"alpha", "bad_input", 0})->attempts, 1);
    EXPECT_EQ(store.read_error({"alpha", "bad_input", 0})->message,
              "the worker ended with exit code 3: clearway-run: its file: no number.\nNor another.");
    EXPECT_EQ(store.read_error({"alpha", "refused", 0})->message, "SUMO said no");
    EXPECT_EQ(store.read_error({"alpha", "forgetful", 0})->cause, ErrorCause::bad_input);
    std::filesystem::remove_all(store.folder() / "logs");
    const StudyResult again = run_in("out");
    EXPECT_EQ(again.progress.failed, 6U);
    EXPECT_TRUE(std::filesystem::is_empty(store.folder() / "logs")) << "no worker was started";
}

TEST_F(Study, ThatIsContinuedTriesAgainWhatTheMachineEnded) {
    for (const char* const condition : {"hog", "told_memory", "crash", "hang"}) {
        plan({"baseline", condition}, 1);
        options_.limits = {.wall_s = 0.2, .memory_mib = 64};
        EXPECT_EQ(run_in(condition).exit_code, ExitCode::runs_failed);
        EXPECT_TRUE(continues_in(condition, RetriedRuns::ended_by_machine)) << condition;
    }
}

TEST_F(Study, ThatIsContinuedTriesAgainWhatTheInputMadeFailOnlyIfAsked) {
    plan({"baseline", "refused"}, 1);
    run_in("refused");
    EXPECT_FALSE(continues_in("refused", RetriedRuns::ended_by_machine));
    EXPECT_TRUE(continues_in("refused", RetriedRuns::all_failed));
}

TEST_F(Study, ThatNeededMoreMemoryIsTheSameOnceItHasIt) {
    plan({"baseline", "large"}, 2);
    run_in("undisturbed");
    options_.limits.memory_mib = 128;
    EXPECT_EQ(run_in("out").exit_code, ExitCode::runs_failed);
    options_.limits.memory_mib = 0;
    EXPECT_EQ(run_in("out").exit_code, ExitCode::ok);
    EXPECT_EQ(tables_of("out"), tables_of("undisturbed"));
}

TEST_F(Study, RecordsARunThatAWorkerForgot) {
    plan({"baseline", "forgetful"}, 1);
    EXPECT_EQ(run_in("out").exit_code, ExitCode::runs_failed);
    EXPECT_THAT(store_in("out").read_error({"alpha", "forgetful", 0})->message,
                testing::HasSubstr("without a record"));
}

TEST_F(Study, StopsWhenTheMachineIsAtFaultAndLosesNothing) {
    plan({"baseline", "disk_full"}, 2);
    EXPECT_THROW(run_in("out", 1), core::EnvironmentError);
    EXPECT_TRUE(store_in("out").complete({"alpha", "baseline", 0}));
    EXPECT_FALSE(store_in("out").read_error({"alpha", "disk_full", 0}));
}

TEST_F(Study, SaysThatItsWorkerIsMissing) {
    plan({"baseline"}, 1);
    options_.worker_program = "/nowhere/clearway-run";
    try {
        run_in("out");
        FAIL();
    } catch (const core::EnvironmentError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("/nowhere/clearway-run cannot be started"));
    }
}

TEST_F(Study, GoesOnAfterKillNineToTheSameBytesAsUndisturbed) {
    plan({"baseline", "slow_a", "slow_b"}, 6);
    run_in("undisturbed");
    const std::string expected = tables_of("undisturbed");
    const results::Store store = store_in("killed");
    for (const std::uint32_t replication : {0U, 2U, 4U}) {
        const pid_t study = fork_study("killed");
        wait_for(store, {"alpha", "slow_a", replication});
        kill(study, SIGKILL);
        waitpid(study, nullptr, 0);
    }
    const StudyResult result = run_in("killed");
    EXPECT_EQ(result.exit_code, ExitCode::ok);
    EXPECT_GT(result.progress.resumed, 8U);
    EXPECT_LT(result.progress.resumed, 36U);
    EXPECT_EQ(tables_of("killed"), expected);
}

TEST_F(Study, MakesDamagedRunsAgainToTheSameBytesAndSaysSo) {
    plan({"baseline", "treated"}, 2);
    run_in("out");
    const std::string expected = tables_of("out");
    const results::Store store = store_in("out");
    std::filesystem::resize_file(store.run_folder({"alpha", "treated", 1}) / "run.json", 40);
    std::vector<RunKey> told;
    options_.on_set_aside = [&](const results::SetAside& damaged) { told.push_back(damaged.key); };
    const StudyResult result = run_in("out");
    EXPECT_EQ(result.exit_code, ExitCode::ok);
    EXPECT_EQ(result.progress.resumed, 7U);
    EXPECT_THAT(told, testing::ElementsAre(RunKey{"alpha", "treated", 1}));
    EXPECT_EQ(tables_of("out"), expected);
    EXPECT_TRUE(std::filesystem::exists(store.folder() / "damaged/alpha/treated/00001/run/run.json"));
}

TEST_F(Study, EndsItsWorkersOnSignalsAndTellsWhich) {
    plan({"baseline", "hang"}, 4);
    for (const auto& [signal, code] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)}) {
        const std::string folder = "out" + std::to_string(signal);
        const results::Store store = store_in(folder);
        const pid_t study = fork_study(folder);
        wait_for(store, {"alpha", "baseline", 0});
        kill(study, signal);
        int status = 0;
        waitpid(study, &status, 0);
        ASSERT_TRUE(WIFEXITED(status));
        EXPECT_EQ(WEXITSTATUS(status), code);
        EXPECT_TRUE(results::read_results(store).errors.empty()) << "an interrupted run has not failed";
    }
}

TEST_F(Study, KeepsItsShareOfTheWorkWhenItIsInterrupted) {
    plan({"baseline", "hang"}, 4);
    const pid_t study = fork();
    if (study == 0) {
        run_in("out");
        const std::size_t reports = reported_.size();
        _exit(reports > 1 && reported_[reports - 1].work >= reported_[reports - 2].work ? 0 : 1);
    }
    wait_for(store_in("out"), {"alpha", "baseline", 0});
    std::this_thread::sleep_for(std::chrono::seconds(1));
    kill(study, SIGINT);
    int status = 0;
    waitpid(study, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0) << "what ran left the work that is done, so the time left leapt";
}

TEST_F(Study, RefusesAFolderInWhichAnotherStudyWorks) {
    plan({"baseline", "hang"}, 1);
    const results::Store store = store_in("out");
    const pid_t study = fork_study("out");
    wait_for(store, {"alpha", "baseline", 0});
    try {
        run_in("out");
        ADD_FAILURE() << "two studies in one folder";
    } catch (const core::EnvironmentError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("process " + std::to_string(study)));
    }
    kill(study, SIGTERM);
    waitpid(study, nullptr, 0);
}

}  // namespace
}  // namespace clearway::campaign
