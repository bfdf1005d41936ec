// Run folders on disks that are full or cannot be written, in use, or of another version: nothing is lost.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "user.hpp"

namespace clearway::cli {
namespace {

class DiskTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
        write("my.toml",
              "replications = 16\nscenarios = [\"./line\"]\nconditions = [\"baseline\", "
              "\"graph_simulation\"]\n");
    }
    void TearDown() override {
        if (mounted_) shell("umount", place());
    }
    /// A file system of its own below the test's folder; false where mounting is not permitted.
    bool mount(const std::string& options) {
        std::filesystem::create_directories(place());
        mounted_ = shell("mount -t tmpfs -o " + options + " tmpfs", place());
        return mounted_;
    }
    void remount(const std::string& options) { ASSERT_TRUE(shell("mount -o remount," + options, place())); }
    std::filesystem::path place() const { return folder() / "disk"; }
    Ended study(const std::string& out) const { return clearway({"study", "my.toml", "--out", out}); }
    void expect_tables_of_an_undisturbed_study() const {
        ASSERT_EQ(study("undisturbed").code, 0);
        for (const char* const table : {"runs.csv", "vehicles.csv", "results.sqlite"})
            EXPECT_EQ(read(std::string("disk/out/") + table), read(std::string("undisturbed/") + table))
                << table;
    }

  private:
    static bool shell(const std::string& command, const std::filesystem::path& place) {
        return std::system((command + " '" + place.string() + "' 2>/dev/null").c_str()) == 0;
    }
    bool mounted_ = false;
};

TEST_F(DiskTest, that_fills_while_workers_write_exits_with_4_and_goes_on_when_there_is_room) {
    if (!mount("size=600k")) GTEST_SKIP() << "mounting a small file system is not permitted";
    const Ended full = study("disk/out");
    EXPECT_EQ(full.code, 4) << full.err;
    EXPECT_THAT(full.err, HasSubstr("Free some space"));
    std::error_code none;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(place() / "out" / "errors", none))
        EXPECT_FALSE(entry.is_regular_file()) << "no run is to blame: " << read(entry.path().string());
    remount("size=64m");
    const Ended resumed = study("disk/out");
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    expect_tables_of_an_undisturbed_study();
}

TEST_F(DiskTest, that_is_read_only_exits_with_4_and_can_still_be_looked_at) {
    if (!mount("size=64m")) GTEST_SKIP() << "mounting a small file system is not permitted";
    remount("ro");
    const Ended fresh = study("disk/out");
    EXPECT_EQ(fresh.code, 4);
    EXPECT_THAT(fresh.err, HasSubstr("disk/out"));
    remount("rw");
    ASSERT_EQ(study("disk/out").code, 0);
    remount("ro");
    const Ended again = study("disk/out");
    EXPECT_EQ(again.code, 4);
    EXPECT_THAT(again.err, HasSubstr("ead-only"));
    const Ended reported = clearway({"report", "disk/out"});
    EXPECT_EQ(reported.code, 4);
    EXPECT_THAT(reported.out, HasSubstr("Graph made by simulation attributes: "))
        << "verdicts are printed all the same";
    EXPECT_THAT(clearway({"study", "status", "disk/out"}).out, HasSubstr("complete; 32 of 32"));
    EXPECT_EQ(clearway({"study", "merge", "disk/out", "--out", "merged"}).code, 0)
        << "copied, for links cannot leave a disk";
    expect_tables_of_an_undisturbed_study();
}

TEST_F(DiskTest, with_a_study_at_work_refuses_a_second_one_and_names_the_first) {
    const core::Child first = start({"study", "my.toml", "--out", "out"});
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!std::filesystem::exists(folder() / "out" / "units") &&
           std::chrono::steady_clock::now() < patience)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const Ended second = study("out");
    EXPECT_EQ(second.code, 4);
    EXPECT_THAT(second.err, AllOf(HasSubstr("another command works in this folder"),
                                  HasSubstr("process " + std::to_string(first.pid))));
    EXPECT_EQ(finish(first).code, 0) << "the first is not disturbed";
}

TEST_F(DiskTest, with_a_folder_of_another_version_is_refused_and_left_alone) {
    ASSERT_EQ(study("out").code, 0);
    std::string manifest = read("out/manifest.json");
    const std::size_t at = manifest.find("\"format\": ");
    manifest.replace(at, manifest.find(',', at) - at, "\"format\": 99");
    write("out/manifest.json", manifest);
    const std::string before = read("out/runs.csv");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"study", "my.toml", "--out", "out"},
          {"report", "out"},
          {"study", "status", "out"},
          {"study", "merge", "out", "--out", "merged"}}) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << words.front();
        EXPECT_THAT(ended.err, AllOf(HasSubstr("format: is 99"), HasSubstr("version"))) << words.front();
    }
    EXPECT_EQ(read("out/runs.csv"), before);
    EXPECT_EQ(read("out/manifest.json"), manifest);
}

TEST_F(DiskTest, gets_nothing_of_a_study_without_replications_conditions_or_scenarios) {
    for (const char* const text :
         {"replications = 0\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n",
          "scenarios = []\nconditions = [\"baseline\"]\n", "scenarios = [\"./line\"]\nconditions = []\n"}) {
        write("my.toml", text);
        EXPECT_EQ(study("out").code, 3) << text;
    }
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

}  // namespace
}  // namespace clearway::cli
