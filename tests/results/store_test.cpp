#include "results/store.hpp"

#include <algorithm>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "results/synthetic.hpp"
#include "results/table_writer.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::results {
namespace {

using synthetic::error;
using synthetic::record;

const experiment::RunKey treated{"alpha", "baseline", 1};

class StoreOfAStudy : public testing::Test {
  protected:
    support::TemporaryFolder folder_;
    Store store_ = Store::create(folder_.path() / "out", synthetic::manifest());

    std::size_t files_below(const std::string& name) const {
        std::size_t count = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(store_.folder() / name))
            count += entry.is_regular_file() ? 1 : 0;
        return count;
    }
};

TEST_F(StoreOfAStudy, GivesBackWhatWasWritten) {
    EXPECT_FALSE(store_.complete(treated));
    EXPECT_FALSE(store_.read(treated));
    RunTiming timing;
    timing.wall_s = 2.5;
    timing.peak_kib = 4096;
    EXPECT_EQ(store_.write(record(treated), timing), Store::Written::first);
    EXPECT_TRUE(store_.complete(treated));
    EXPECT_EQ(*store_.read(treated), record(treated));
    EXPECT_DOUBLE_EQ(store_.read_timing(treated)->wall_s, 2.5);
    EXPECT_EQ(store_.read_timing(treated)->peak_kib, 4096);
}

TEST_F(StoreOfAStudy, KeepsWhereTimeWasLostAndReadsJourneysEdgeTimesAndHoldsOnlyWhenAskedFor) {
    RunRecord run = record(treated);
    run.traffic = synthetic::traffic_tables();
    store_.write(run, {});
    EXPECT_EQ(store_.read_traffic(treated), run.traffic);
    EXPECT_EQ(store_.read_traffic({"alpha", "baseline", 0}), metrics::TrafficTables{});
    run.traffic.journeys.clear();
    run.traffic.edge_times.clear();
    run.traffic.holds.clear();
    run.traffic.locks.clear();
    run.traffic.considered.clear();
    EXPECT_EQ(store_.read(treated), run);
}

TEST_F(StoreOfAStudy, MayBeNamedWithASlashAtItsEnd) {
    const Store named = Store::open(store_.folder() / "");
    EXPECT_EQ(named.folder(), store_.folder());
    named.write(record(treated), {});
    named.flush({treated});
    EXPECT_TRUE(store_.complete(treated));
}

TEST_F(StoreOfAStudy, ReadsEmergencyVehiclesAloneWhereThatIsEnough) {
    store_.write(record(treated), {});
    const RunRecord run = store_.read(treated, VehicleRows::emergency).value();
    ASSERT_EQ(run.vehicles.size(), 1U);
    EXPECT_EQ(run.vehicles[0], record(treated).vehicles[0]);
    EXPECT_EQ(run.metrics, record(treated).metrics);
}

TEST_F(StoreOfAStudy, KeepsTheFirstOfTwoEqualRunsWhateverTheyTook) {
    RunTiming slow;
    slow.wall_s = 9.0;
    store_.write(record(treated), {});
    EXPECT_EQ(store_.write(record(treated), slow), Store::Written::already_there);
    EXPECT_DOUBLE_EQ(store_.read_timing(treated)->wall_s, 0.0);
    EXPECT_EQ(files_below("runs"), 3U);
}

TEST_F(StoreOfAStudy, RefusesASecondRunThatDiffersInNumbersOrVehicles) {
    store_.write(record(treated), {});
    RunRecord other = record(treated);
    other.metrics.collisions = 99;
    EXPECT_THROW(store_.write(other, {}), core::ConflictError);
    other = record(treated);
    other.vehicles[0].waiting_time_s = 1.0;
    EXPECT_THROW(store_.write(other, {}), core::ConflictError);
    EXPECT_EQ(*store_.read(treated), record(treated));
    EXPECT_EQ(files_below("runs"), 3U);
}

TEST_F(StoreOfAStudy, NoticesARecordThatWasEdited) {
    store_.write(record(treated), {});
    const auto file = store_.run_folder(treated) / "vehicles.csv";
    std::string text = core::read_file(file);
    text.replace(text.find("80"), 2, "81");
    core::write_atomically(file, text);
    EXPECT_THROW(store_.read(treated), core::InputError);
}

/// Replaces the first `from` in a file.
void edit(const std::filesystem::path& file, const std::string& from, const std::string& to) {
    std::string text = core::read_file(file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, from.size(), to);
    core::write_atomically(file, text);
}

TEST_F(StoreOfAStudy, NoticesAnEditedNumberOfTheRunItself) {
    store_.write(record(treated), {});
    edit(store_.run_folder(treated) / "run.json", "600.25", "600.75");
    try {
        store_.read(treated);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("run.json: hash"),
                                                 testing::HasSubstr("sets the record aside")));
    }
}

TEST_F(StoreOfAStudy, RefusesARecordOfAnotherStudyAndSaysInWhat) {
    Manifest other = synthetic::manifest();
    other.clearway_build = "0123456789abcdef";
    other.sumo_version = "1.16.0";
    other.study_seed = 9;
    other.scenarios[0].configuration_hash = std::string(32, 'c');
    other.conditions[0].settings = {{"policy.period_s", "2"}};
    const Store elsewhere = Store::create(folder_.path() / "other", other);
    synthetic::write(elsewhere, record(treated));
    EXPECT_TRUE(elsewhere.read(treated));
    core::make_folder(store_.run_folder(treated).parent_path());
    std::filesystem::copy(elsewhere.run_folder(treated), store_.run_folder(treated));
    try {
        store_.read(treated);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_EQ(error.problems().size(), 5U);
        EXPECT_THAT(error.what(),
                    testing::AllOf(testing::HasSubstr("run.json: configuration_hash: is \"cccc"),
                                   testing::HasSubstr("\"aaaa"), testing::HasSubstr("study_seed: is \"9\""),
                                   testing::HasSubstr("sumo_version: is \"1.16.0\""),
                                   testing::HasSubstr("build: is \"0123456789abcdef\""),
                                   testing::HasSubstr("condition_spec: differs in settings"),
                                   testing::HasSubstr("as in manifest.json"),
                                   testing::HasSubstr("Repeat the command")));
    }
    const std::vector<SetAside> aside = store_.set_damaged_aside({treated});
    ASSERT_EQ(aside.size(), 1U);
    EXPECT_FALSE(store_.complete(treated));
}

TEST_F(StoreOfAStudy, RefusesARecordUnderTheNameOfAnotherRun) {
    store_.write(record(treated), {});
    const experiment::RunKey other{"alpha", "treated", 1};
    core::make_folder(store_.run_folder(other).parent_path());
    std::filesystem::copy(store_.run_folder(treated), store_.run_folder(other));
    EXPECT_THROW(store_.read(other), core::InputError);
}

TEST_F(StoreOfAStudy, RefusesARecordThatLacksAMetricAndSaysHowToMakeItAgain) {
    store_.write(record(treated, 50.5), {});
    const std::filesystem::path file = store_.run_folder(treated) / "run.json";
    nlohmann::ordered_json object = nlohmann::ordered_json::parse(core::read_file(file));
    object["metrics"].erase("emergency_restricted_travel_time_s");
    object.erase("hash");
    object["hash"] = core::content_hash(core::to_text(object));
    core::write_atomically(file, core::to_text(object));
    try {
        store_.read(treated);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("emergency_restricted_travel_time_s"),
                                                 testing::HasSubstr("makes the run again")));
    }
}

TEST_F(StoreOfAStudy, KeepsARunWhoseTimingWasLostWithThePower) {
    const Store other = Store::create(folder_.path() / "other", store_.manifest());
    store_.write(record(treated), {});
    const std::filesystem::path file = store_.run_folder(treated) / "timing.json";
    for (const std::string& left : {std::string(), std::string(150, '\0')}) {
        core::write_atomically(file, left);
        EXPECT_FALSE(store_.read_timing(treated)) << left.size();
        EXPECT_NO_THROW(store_.check(treated)) << left.size();
        EXPECT_TRUE(store_.set_damaged_aside({treated}).empty()) << left.size();
        EXPECT_NO_THROW(other.adopt(store_, treated)) << left.size();
        EXPECT_TRUE(other.complete(treated)) << left.size();
    }
    core::write_atomically(file, std::string(150, '\0') + "}");
    EXPECT_THROW(store_.read_timing(treated), core::InputError) << "it is not all lost";
    EXPECT_THROW(store_.check(treated), core::InputError);
}

TEST_F(StoreOfAStudy, SetsDamagedRunsAsideWithoutLosingThem) {
    const std::vector<experiment::RunKey> keys = store_.manifest().runs();
    for (const experiment::RunKey& each : keys)
        store_.write(record(each), {});
    EXPECT_TRUE(store_.set_damaged_aside(keys).empty());
    const auto file = [&](std::size_t run, const char* name) { return store_.run_folder(keys[run]) / name; };
    edit(file(0, "run.json"), "600.25", "600.75");
    std::filesystem::resize_file(file(1, "run.json"), 100);
    std::filesystem::resize_file(file(2, "vehicles.csv"), 60);
    std::filesystem::remove(file(3, "run.json"));
    std::filesystem::resize_file(file(4, "timing.json"), 5);
    const std::string cut = core::read_file(file(1, "run.json"));

    const std::vector<SetAside> moved = store_.set_damaged_aside(keys);
    ASSERT_EQ(moved.size(), 5U);
    for (std::size_t i = 0; i < moved.size(); ++i) {
        EXPECT_EQ(moved[i].key, keys[i]);
        EXPECT_THAT(moved[i].why, testing::HasSubstr(store_.run_folder(keys[i]).string()));
        EXPECT_FALSE(store_.complete(keys[i]));
        EXPECT_EQ(store_.write(record(keys[i]), {}), Store::Written::first);
    }
    EXPECT_EQ(core::read_file(moved[1].place / "run" / "run.json"), cut);
    EXPECT_TRUE(store_.set_damaged_aside(keys).empty());
    edit(file(0, "run.json"), "600.25", "600.75");
    EXPECT_NE(store_.set_damaged_aside(keys).at(0).place, moved[0].place) << "the first one is kept, too";
}

TEST_F(StoreOfAStudy, SetsADamagedFailureAside) {
    store_.write(error(treated));
    std::filesystem::resize_file(store_.folder() / "errors" / "alpha" / "baseline" / "00001.json", 9);
    EXPECT_THROW(store_.read_error(treated), core::InputError);
    const std::vector<SetAside> moved = store_.set_damaged_aside({treated});
    ASSERT_EQ(moved.size(), 1U);
    EXPECT_FALSE(store_.read_error(treated));
    EXPECT_TRUE(std::filesystem::exists(moved[0].place / "error.json"));
}

TEST_F(StoreOfAStudy, RefusesAFailureOfAnotherRunThanItsPlaceSays) {
    store_.write(error(treated));
    const std::filesystem::path file = store_.folder() / "errors" / "alpha" / "baseline" / "00001.json";
    std::string text = core::read_file(file);
    text.replace(text.find("\"alpha\""), 7, "\"../../../escaped\"");
    core::write_atomically(file, text);
    try {
        store_.read_error(treated);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr(file.string()),
                                                 testing::HasSubstr("../../../escaped/baseline/1"),
                                                 testing::HasSubstr("allowed: alpha/baseline/1")));
    }
}

TEST(StoreOfANewFolder, IsMadeWhereACallWasKilledAtTheFirstManifest) {
    const support::TemporaryFolder folder;
    const std::filesystem::path out = folder.path() / "out";
    std::filesystem::create_directories(out);
    core::write_atomically(out / "manifest.json.2147483647.clearway-part", "{");
    EXPECT_EQ(Store::create(out, synthetic::manifest()).manifest(), synthetic::manifest());
    EXPECT_FALSE(std::filesystem::exists(out / "manifest.json.2147483647.clearway-part"));
}

TEST_F(StoreOfAStudy, RemembersAFailureUntilTheRunSucceeds) {
    store_.write(error(treated));
    EXPECT_EQ(*store_.read_error(treated), error(treated));
    EXPECT_FALSE(store_.complete(treated));
    store_.write(record(treated), {});
    EXPECT_FALSE(store_.read_error(treated));
    store_.write(error(treated));
    EXPECT_FALSE(store_.read_error(treated)) << "a complete run cannot fail afterwards";
}

TEST_F(StoreOfAStudy, IsOpenedAgainForTheSameStudyAndRefusedToAnother) {
    EXPECT_EQ(Store::create(store_.folder(), synthetic::manifest()).manifest(), synthetic::manifest());
    Manifest other = synthetic::manifest();
    other.study_seed = 5;
    other.replications = 9;
    try {
        Store::create(store_.folder(), other);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("different seed. Choose")) << "more seeds do not block";
    }
}

TEST(StoreOfABuild, SaysInEachRunWhichBuildMadeItAndWhenAndRefusesAnother) {
    const support::TemporaryFolder folder;
    Manifest manifest = synthetic::manifest();
    manifest.clearway_build = "0123456789abcdef";
    const Store store = Store::create(folder.path() / "out", manifest);
    store.write(record(treated), {});
    EXPECT_EQ(Store::open(store.folder()).manifest(), manifest);
    EXPECT_EQ(store.read(treated)->build, manifest.clearway_build);
    EXPECT_THAT(store.read_timing(treated)->made_at, testing::MatchesRegex("20..-..-..T..:..:..Z"));
    write_tables(store);
    EXPECT_THAT(core::read_file(store.runs_csv()), testing::HasSubstr(",0123456789abcdef\n"));
    for (const char* const other : {"fedcba9876543210", ""}) {
        Manifest longer = manifest;
        longer.replications += 5;
        longer.clearway_build = other;
        EXPECT_EQ(differences(longer, manifest), "build of Clearway, replications");
        longer.replications = manifest.replications;
        try {
            Store::create(store.folder(), longer);
            FAIL() << other;
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(),
                        testing::HasSubstr("was made by another build of Clearway: 0123456789abcdef"));
            EXPECT_THAT(error.what(), testing::HasSubstr("another folder with --out"));
        }
    }
}

TEST_F(StoreOfAStudy, IsExtendedByMoreReplicationsAndNeverCutByFewer) {
    store_.write(record(treated), {});
    const Store longer = Store::create(store_.folder(), synthetic::manifest(5));
    EXPECT_EQ(longer.manifest().replications, 5U);
    EXPECT_TRUE(longer.complete(treated));
    EXPECT_EQ(Store::open(store_.folder()).manifest(), synthetic::manifest(5));
    try {
        Store::create(store_.folder(), synthetic::manifest(4));
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("holds 5 replications of this study, and 4 are asked"));
    }
    EXPECT_EQ(Store::open(store_.folder()).manifest().replications, 5U);
}

TEST_F(StoreOfAStudy, DoesNotTakeOverAFolderOfSomethingElse) {
    folder_.write("notes.txt", "mine");
    EXPECT_THROW(Store::create(folder_.path(), synthetic::manifest()), core::InputError);
    EXPECT_THROW(Store::open(folder_.path()), core::InputError);
}

/// Files of this process have at most so many bytes while it lives.
class FileLimit {
  public:
    explicit FileLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit tight{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &tight);
    }
    ~FileLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

  private:
    rlimit before_{};
    void (*handler_)(int);
};

TEST_F(StoreOfAStudy, SaysThatADatabaseIsOverTheLimitOfFilesNotThatTheDiskIsFull) {
    store_.write(record(treated), {});
    try {
        const FileLimit limit(16384);
        write_tables(store_);
        FAIL();
    } catch (const core::EnvironmentError& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(testing::HasSubstr("results.sqlite"), testing::HasSubstr("File too large"),
                                   testing::HasSubstr("`ulimit -f`")));
        EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("full")));
    }
}

TEST_F(StoreOfAStudy, FailsWithoutATraceWhenTheDiskTakesNoMore) {
    {  // A limit on file sizes fails writes half-way, as a full disk does.
        const FileLimit limit(200);
        EXPECT_THROW(store_.write(record(treated), {}), core::EnvironmentError);
    }
    EXPECT_FALSE(store_.complete(treated));
    EXPECT_EQ(files_below("runs"), 0U);
    EXPECT_EQ(store_.write(record(treated), {}), Store::Written::first);
}

TEST_F(StoreOfAStudy, LeavesWholeRunsOrNoneWhenAWriterIsKilled) {
    const pid_t writer = fork();
    if (writer == 0) {
        for (std::uint32_t replication = 0;; ++replication)
            store_.write(record({"beta", "treated", replication}), {});
    }
    while (!store_.complete({"beta", "treated", 20}))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    std::uint32_t whole = 0;
    while (store_.complete({"beta", "treated", whole})) {
        const experiment::RunKey written{"beta", "treated", whole};
        EXPECT_EQ(*store_.read(written), record(written));
        ++whole;
    }
    EXPECT_GE(whole, 21U);
    store_.remove_leftovers();
    EXPECT_EQ(files_below("runs"), 3U * whole);
}

TEST_F(StoreOfAStudy, LetsOneOfManyWritersWin) {
    std::vector<pid_t> writers;
    for (int writer = 0; writer < 4; ++writer) {
        const pid_t child = fork();
        if (child == 0) {
            int firsts = 0;
            for (std::uint32_t replication = 0; replication < 20; ++replication)
                firsts +=
                    store_.write(record({"beta", "baseline", replication}), {}) == Store::Written::first;
            _exit(firsts);
        }
        writers.push_back(child);
    }
    int firsts = 0;
    for (const pid_t writer : writers) {
        int status = 0;
        waitpid(writer, &status, 0);
        ASSERT_TRUE(WIFEXITED(status));
        firsts += WEXITSTATUS(status);
    }
    EXPECT_EQ(firsts, 20);
    EXPECT_EQ(files_below("runs"), 60U);
}

}  // namespace
}  // namespace clearway::results
