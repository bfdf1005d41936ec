#include "study/merge.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "results/synthetic.hpp"
#include "results/table_writer.hpp"
#include "scenario/config.hpp"
#include "study/folder_lock.hpp"
#include "study/shard.hpp"
#include "study/status.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study {
namespace {

using experiment::RunKey;
using results::Store;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint32_t merged_replications = 5;

class Merge : public testing::Test {
  protected:
    std::filesystem::path place(const std::string& name) const { return folder_.path() / name; }
    Store store(const std::string& name, std::uint64_t seed = 1) const {
        results::Manifest manifest = results::synthetic::manifest(merged_replications);
        manifest.study_seed = seed;
        return Store::create(place(name), manifest);
    }
    /// Run folders `FIRST1` to `FIRSTn`, each with every n-th run.
    std::vector<std::filesystem::path> divided(std::size_t count, const std::string& first) const {
        std::vector<std::filesystem::path> folders;
        const std::vector<RunKey> keys = results::synthetic::manifest(merged_replications).runs();
        for (std::size_t part = 0; part < count; ++part) {
            const std::string name = first + std::to_string(part + 1);
            claim(place(name), {static_cast<std::uint32_t>(part + 1), static_cast<std::uint32_t>(count)});
            const Store shard = store(name);
            for (std::size_t i = part; i < keys.size(); i += count)
                shard.write(results::synthetic::record(keys[i], 40.0 + static_cast<double>(i)), {});
            folders.push_back(place(name));
        }
        return folders;
    }
    MergeResult merge_into(const std::string& out, const std::vector<std::filesystem::path>& sources) const {
        return merge(sources, place(out), [](std::size_t) {});
    }
    std::string tables_of(const std::string& name) const {
        std::string all;
        for (const char* file : {"runs.csv", "vehicles.csv", "results.sqlite"})
            all += core::read_file(place(name) / file);
        return all;
    }
    /// Scenario `alpha` as a study completes it, but for the content of its network.
    void put_scenario(const std::filesystem::path& folder) const {
        const std::filesystem::path alpha = folder / "scenarios" / "alpha";
        core::make_folder(alpha / "network");
        core::make_folder(alpha / "demand" / folder.filename());
        scenario::store(scenario::load("merge"), alpha);
        for (const char* const name : {"network/network.net.xml", "network.svg"})
            core::write_atomically(alpha / name, name);
        core::write_atomically(alpha / "network" / "network.hash",
                               core::content_hash("network/network.net.xml"));
    }
    support::TemporaryFolder folder_;
};

TEST_F(Merge, GivesTheSameBytesForAnyNumberAndOrderOfShards) {
    EXPECT_EQ(merge_into("whole", divided(1, "a")).counts.complete, 20U);
    merge_into("thirds", divided(3, "b"));
    auto reversed = divided(7, "c");
    std::ranges::reverse(reversed);
    merge_into("sevenths", reversed);
    EXPECT_EQ(tables_of("thirds"), tables_of("whole"));
    EXPECT_EQ(tables_of("sevenths"), tables_of("whole"));
    const Store single = store("whole");
    results::write_tables(single);
    EXPECT_EQ(tables_of("thirds"), tables_of("whole")) << "as a study on one machine writes them";
}

TEST_F(Merge, TakesDuplicatesThatAreEqualOnce) {
    auto sources = divided(2, "a");
    const auto again = divided(2, "b");
    sources.insert(sources.end(), again.begin(), again.end());
    const MergeResult result = merge_into("out", sources);
    EXPECT_EQ(result.counts.complete, 20U);
    EXPECT_EQ(result.adopted, 20U);
    EXPECT_EQ(result.duplicates, 20U);
}

TEST_F(Merge, NamesTheRunOfWhichTwoRecordsDiffer) {
    const RunKey key{"beta", "treated", 3};
    store("a").write(results::synthetic::record(key, 50.0), {});
    store("b").write(results::synthetic::record(key, 50.5), {});
    try {
        merge_into("out", {place("a"), place("b")});
        FAIL();
    } catch (const core::ConflictError& error) {
        EXPECT_EQ(error.exit_code(), core::ExitCode::conflict);
        EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("beta/treated/3"), HasSubstr(place("a").string()),
                                                 HasSubstr(place("b").string())));
    }
    EXPECT_TRUE(store("a").complete(key)) << "nothing is lost";
    EXPECT_TRUE(store("b").complete(key));
}

TEST_F(Merge, RefusesAnotherStudyBeforeItTouchesAnything) {
    store("a");
    store("b", 2);
    try {
        merge_into("out", {place("a"), place("b")});
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(HasSubstr(place("b").string()), HasSubstr("different seed")));
    }
    EXPECT_FALSE(std::filesystem::exists(place("out")));
    EXPECT_THROW(merge_into("out", {folder_.path() / "nothing"}), core::InputError);
}

TEST_F(Merge, RefusesShardsOfTwoBuilds) {
    results::Manifest manifest = results::synthetic::manifest(merged_replications);
    for (const char* const build : {"0123456789abcdef", "fedcba9876543210"}) {
        manifest.clearway_build = build;
        Store::create(place(build), manifest);
    }
    try {
        merge_into("out", {place("0123456789abcdef"), place("fedcba9876543210")});
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("another build of Clearway"));
        EXPECT_THAT(error.what(), HasSubstr("fedcba9876543210, not 0123456789abcdef"));
    }
    EXPECT_FALSE(std::filesystem::exists(place("out")));
}

TEST_F(Merge, SaysWhatIsMissingAndIsCompletedLater) {
    auto sources = divided(4, "a");
    const auto last = sources.back();
    sources.pop_back();
    const MergeResult part = merge_into("out", sources);
    EXPECT_EQ(part.counts.missing, 5U);
    EXPECT_THAT(part.absent_shards, ElementsAre("4/4"));
    ASSERT_EQ(part.missing.size(), 5U);
    EXPECT_EQ(experiment::to_text(part.missing.front()), "alpha/baseline/3");
    EXPECT_EQ(merge_into("out", {last}).counts.complete, 20U);
    merge_into("whole", divided(1, "b"));
    EXPECT_EQ(tables_of("out"), tables_of("whole"));
}

TEST_F(Merge, PrefersARecordToAFailureOfTheSameRun) {
    const RunKey done{"alpha", "baseline", 0};
    const RunKey failed{"alpha", "baseline", 1};
    for (const RunKey& key : {done, failed})
        store("a").write(results::synthetic::error(key));
    store("b").write(results::synthetic::record(done), {});
    const MergeResult result = merge_into("out", {place("b"), place("a")});
    EXPECT_EQ(result.counts.complete, 1U);
    EXPECT_EQ(result.counts.failed, 1U);
    EXPECT_EQ(store("out").read_error(failed)->cause, results::ErrorCause::signal);
}

TEST_F(Merge, FindsTheShardsOfASubmission) {
    const Store shard = Store::create(place("all") / "shards" / "1-of-2", results::synthetic::manifest(1));
    std::filesystem::create_directories(place("all") / "shards" / "2-of-2");
    EXPECT_THAT(run_folders(place("all")), ElementsAre(shard.folder()));
}

TEST_F(Merge, LeavesNoTraceOfAFolderThatCannotBeWritten) {
    const auto sources = divided(2, "a");
    core::write_atomically(place("file"), "");
    EXPECT_THROW(merge_into("file/out", sources), core::EnvironmentError);
    EXPECT_TRUE(store("a1").complete({"alpha", "baseline", 0}));
}

class Status : public Merge {};

TEST_F(Status, CountsRunsByCellInAnyState) {
    const Store shared = store("out");
    EXPECT_EQ(read_status(place("out")).state, State::stopped);
    shared.write(results::synthetic::record({"alpha", "treated", 0}), {});
    shared.write(results::synthetic::error({"alpha", "treated", 1}));
    const StudyStatus part = read_status(place("out"));
    EXPECT_EQ(part.runs, 20U);
    EXPECT_EQ(part.complete, 1U);
    EXPECT_EQ(part.failed, 1U);
    EXPECT_EQ(part.cells.at(1).condition, "treated");
    EXPECT_EQ(part.cells.at(1).failed, 1U);
    shared.manifest().for_each_run(
        [&](const RunKey& key) { shared.write(results::synthetic::record(key), {}); });
    EXPECT_EQ(read_status(place("out")).state, State::complete);
}

TEST_F(Status, CountsTheRunsOfAShard) {
    claim(place("half"), {1, 2});
    store("half");
    EXPECT_EQ(read_status(place("half")).runs, 10U);
}

TEST_F(Status, SeesWhoWorksThereFromAnotherProcessAndWhenHeIsDead) {
    store("out");
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t worker = fork();
    if (worker == 0) {
        const FolderLock lock(place("out"));
        lock.note(3);
        (void)!write(ready[1], "x", 1);
        pause();
    }
    char letter = 0;
    ASSERT_EQ(read(ready[0], &letter, 1), 1);
    const StudyStatus running = read_status(place("out"));
    EXPECT_EQ(running.state, State::running);
    EXPECT_THAT(running.holder, HasSubstr("process " + std::to_string(worker)));
    EXPECT_FALSE(running.time_left_s) << "no run has ended since it began";
    EXPECT_THROW(FolderLock second(place("out")), core::EnvironmentError) << "looking took no lock";
    // Six runs of 22 s in all, three of them before; 64.7 s are open: 1 and 27 s, and ten runs like the mean.
    const auto end_runs = [&](const char* scenario, const char* condition, std::uint32_t runs,
                              double wall_s) {
        results::RunTiming timing;
        timing.wall_s = wall_s;
        for (std::uint32_t i = 0; i < runs; ++i)
            store("out").write(results::synthetic::record({scenario, condition, i}), timing);
    };
    end_runs("alpha", "baseline", 4, 1.0);
    end_runs("beta", "treated", 2, 9.0);
    const auto elapsed_s = [started_s = holder_of(place("out")).value().started_unix_s] {
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        return std::chrono::duration<double>(now).count() - started_s;
    };
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const double least_s = elapsed_s();
    const double left_s = read_status(place("out")).time_left_s.value();
    EXPECT_GT(left_s, 5.87 * least_s);
    EXPECT_LT(left_s, 5.89 * elapsed_s());
    kill(worker, SIGKILL);
    waitpid(worker, nullptr, 0);
    EXPECT_EQ(read_status(place("out")).state, State::stopped);
    close(ready[0]);
    close(ready[1]);
}

TEST_F(Merge, RefusesAShardWhoseNamesLeadOutOfTheFolder) {
    store("a");
    results::Manifest manifest = results::synthetic::manifest(merged_replications);
    manifest.scenarios[0].name = "../../escaped";
    core::write_atomically(place("a") / "manifest.json", results::to_json(manifest));
    std::filesystem::create_directories(place("a") / "scenarios");
    std::filesystem::create_directories(place("escaped"));
    core::write_atomically(place("escaped") / "network.svg", "<svg/>");
    EXPECT_THROW(merge_into("below/out", {place("a")}), core::InputError);
    EXPECT_FALSE(std::filesystem::exists(place("below")));
}

TEST_F(Merge, RefusesByNameWhatIsNeitherFileNorFolderInAShard) {
    const auto refusal_of = [&](const std::string& name) {
        std::string said;
        try {
            merge_into("out", {place("a")});
        } catch (const core::InputError& error) {
            said = error.what();
        }
        EXPECT_THAT(said, HasSubstr((place("a") / name).string() + ": is "));
        EXPECT_FALSE(std::filesystem::exists(place("out")));
        std::filesystem::remove(place("a") / name);
        return said;
    };
    divided(1, "shard");
    std::filesystem::rename(place("shard1"), place("a"));
    core::write_atomically(place("secret"), "of another user");
    std::filesystem::create_directories(place("a") / "training" / "net");
    for (const char* const name :
         {"command.txt", "titles.json", "runs/alpha/baseline/00000/more.txt", "training/net/losses.csv"}) {
        std::filesystem::create_symlink(place("secret"), place("a") / name);
        EXPECT_THAT(refusal_of(name), HasSubstr("is a symbolic link (allowed: files and folders)"));
        std::filesystem::create_directory_symlink("..", place("a") / name);
        EXPECT_THAT(refusal_of(name), HasSubstr("is a symbolic link"));
        ASSERT_EQ(mkfifo((place("a") / name).c_str(), 0600), 0);
        EXPECT_THAT(refusal_of(name), HasSubstr("is neither a file nor a folder"));
    }
    std::filesystem::remove(place("a") / "manifest.json");
    std::filesystem::create_symlink("manifest.json", place("a") / "manifest.json");
    EXPECT_THAT(refusal_of("manifest.json"), HasSubstr("is a symbolic link"));
}

TEST_F(Merge, NeverAdoptsADamagedRecord) {
    const std::vector<std::filesystem::path> sources = divided(1, "a");
    const std::filesystem::path record = sources[0] / "runs" / "beta" / "treated" / "00003" / "run.json";
    const std::string whole = core::read_file(record);
    std::filesystem::resize_file(record, 0);
    const MergeResult lacking = merge_into("out", sources);
    EXPECT_EQ(lacking.counts.complete, 19U);
    EXPECT_THAT(lacking.missing, ElementsAre(RunKey{"beta", "treated", 3}));
    EXPECT_THAT(lacking.damaged,
                ElementsAre(testing::AllOf(HasSubstr(record.string()), HasSubstr("left out"))));
    core::write_atomically(record, whole);
    const MergeResult result = merge_into("out", sources);
    EXPECT_EQ(result.counts.complete, 20U);
    EXPECT_THAT(result.damaged, testing::IsEmpty());
}

TEST_F(Merge, ReplacesADamagedRecordThatItAlreadyHas) {
    const std::vector<std::filesystem::path> sources = divided(1, "a");
    merge_into("out", sources);
    const std::string tables = tables_of("out");
    const std::filesystem::path run = place("out") / "runs" / "beta" / "treated" / "00003";
    for (const char* const name : {"run.json", "vehicles.csv"}) {
        std::filesystem::remove(run / name);  // A link: the shard's own file must stay whole.
        core::write_atomically(run / name, "");
        const MergeResult result = merge_into("out", sources);
        EXPECT_EQ(result.counts.complete, 20U);
        EXPECT_EQ(result.adopted, 1U);
        EXPECT_THAT(result.damaged,
                    ElementsAre(testing::AllOf(HasSubstr(run.string()), HasSubstr("is kept in"))));
        EXPECT_EQ(tables_of("out"), tables);
    }
    std::filesystem::remove(run / "run.json");
    EXPECT_EQ(merge_into("out", sources).counts.complete, 20U) << "a folder without a record blocks nothing";
}

TEST_F(Merge, NamesARecordingThatIsDamagedEverywhereOnce) {
    const std::vector<std::filesystem::path> sources = {divided(1, "a")[0], divided(1, "b")[0]};
    for (const std::filesystem::path& source : sources) {
        const std::filesystem::path recordings = source / "recordings" / "beta" / "treated";
        core::make_folder(recordings);
        core::write_atomically(recordings / "00003.h5", "not what it was");
    }
    const MergeResult result = merge_into("out", sources);
    EXPECT_EQ(result.counts.complete, 20U);
    EXPECT_EQ(result.damaged.size(), 2U);
    EXPECT_THAT(result.lost, ElementsAre("recording " + experiment::to_text(RunKey{"beta", "treated", 3})));
}

TEST_F(Merge, ReplacesCopiesThatAPowerFailureEmptiedAndTakesNone) {
    results::Manifest manifest = results::synthetic::manifest(merged_replications);
    manifest.scenarios[0].configuration_hash = scenario::scenario_hash(scenario::load("merge"));
    const std::vector<std::filesystem::path> sources = {place("a1"), place("a2")};
    for (const std::filesystem::path& source : sources) {
        Store::create(source, manifest);
        put_scenario(source);
    }
    const std::filesystem::path copy = place("out") / "scenarios" / "alpha" / "network" / "network.net.xml";
    std::filesystem::resize_file(sources[0] / "scenarios" / "alpha" / "network" / "network.net.xml", 0);
    merge_into("out", sources);
    EXPECT_EQ(core::read_file(copy), "network/network.net.xml") << "from the shard that has it whole";
    for (const char* const damage : {"", "network/network.net.XML"}) {
        core::write_atomically(copy, damage);
        merge_into("out", sources);
        EXPECT_EQ(core::read_file(copy), "network/network.net.xml");
    }
    // One that was damaged later replaces nothing, and is told where nobody has it whole.
    for (const char* const name : {"network/network.net.xml", "scenario.toml", "merge.edg.xml"}) {
        const std::filesystem::path damaged = sources[1] / "scenarios" / "alpha" / name;
        const std::string whole = core::read_file(damaged);
        core::write_atomically(damaged, whole.substr(0, whole.size() / 2));
        const MergeResult intact = merge_into("out", {sources[1]});
        EXPECT_THAT(intact.damaged, testing::IsEmpty()) << name;
        EXPECT_THAT(intact.lost, testing::IsEmpty()) << name;
        EXPECT_EQ(core::read_file(copy), "network/network.net.xml") << name;
        const MergeResult other = merge_into("other", {sources[1]});
        EXPECT_THAT(other.damaged, ElementsAre(HasSubstr("It is left out"))) << name;
        EXPECT_THAT(other.lost, ElementsAre("scenario alpha")) << name;
        EXPECT_FALSE(std::filesystem::exists(place("other") / "scenarios" / "alpha")) << name;
        core::write_atomically(damaged, whole);
    }
    std::filesystem::remove(copy);
    merge_into("out", sources);
    EXPECT_EQ(core::read_file(copy), "network/network.net.xml");
    const auto before = std::filesystem::last_write_time(copy);
    merge_into("out", sources);
    EXPECT_EQ(std::filesystem::last_write_time(copy), before) << "an equal copy stays";
    EXPECT_FALSE(std::filesystem::exists(place("out") / "scenarios" / "alpha" / "demand"));
}

}  // namespace
}  // namespace clearway::study
