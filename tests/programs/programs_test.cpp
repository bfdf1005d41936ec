// The three programs: what each is linked to, and how it answers a wrong call.
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "core/files.hpp"
#include "core/process.hpp"
#include "support/temporary_folder.hpp"

namespace clearway {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Answer {
    core::Exit exit;
    std::string text;  ///< Both streams.
};

Answer call(const std::string& program, const std::vector<std::string>& arguments,
            const std::map<std::string, std::string>& environment = {}) {
    const support::TemporaryFolder folder;
    const std::filesystem::path log = folder.path() / "log.txt";
    const core::Exit exit = core::run({program, arguments, environment, log});
    return {exit, core::read_file(log)};
}

std::string path_of(const std::string& program) {
    return std::string(CLEARWAY_BINARY_DIR) + "/bin/" + program;
}

std::string libraries_of(const std::string& program) {
    return call("ldd", {path_of(program)}).text;
}

TEST(ProgramsTest, clearway_is_linked_to_neither_sumo_nor_torch) {
    EXPECT_THAT(libraries_of("clearway"),
                AllOf(HasSubstr("libstdc++"), Not(HasSubstr("libsumo")), Not(HasSubstr("libtorch"))));
}

TEST(ProgramsTest, the_worker_holds_sumo_but_no_torch) {
    EXPECT_THAT(libraries_of("clearway-run"), AllOf(HasSubstr("libsumo"), Not(HasSubstr("libtorch"))));
}

TEST(ProgramsTest, the_trainer_holds_torch_but_no_sumo) {
    if (!std::filesystem::exists(path_of("clearway-train")))
        GTEST_SKIP() << "clearway-train is not built: it needs libtorch and XGBoost";
    EXPECT_THAT(libraries_of("clearway-train"), AllOf(HasSubstr("libtorch"), Not(HasSubstr("libsumo"))));
}

TEST(ProgramsTest, the_worker_tells_both_versions_and_its_build) {
    const Answer answer = call(path_of("clearway-run"), {"--version"});
    EXPECT_TRUE(answer.exit.ok());
    EXPECT_THAT(answer.text,
                testing::MatchesRegex("clearway-run [0-9.]+ with SUMO [0-9.]+\nbuild [0-9a-f]+\n"));
}

TEST(ProgramsTest, an_installed_program_finds_its_scenarios_in_share) {
    const support::TemporaryFolder prefix;
    const std::filesystem::path programs = prefix.path() / "lib/clearway";
    const std::filesystem::path merge = prefix.path() / "share/clearway/scenarios/merge";
    std::filesystem::create_directories(programs);
    std::filesystem::create_directories(merge);
    std::filesystem::copy(path_of("clearway"), programs);
    std::filesystem::copy(std::string(CLEARWAY_SOURCE_DIR) + "/scenarios/merge", merge);
    const auto list = [&programs] { return call(programs / "clearway", {"list"}, {{"CLEARWAY_HOME", ""}}); };
    const Answer found = list();
    EXPECT_TRUE(found.exit.ok());
    EXPECT_THAT(found.text, HasSubstr("merge"));
    std::filesystem::remove_all(merge);
    EXPECT_THAT(list().text,
                HasSubstr("no folder 'scenarios' or 'share/clearway/scenarios' above the program"));
}

/// `clearway` with a worker beside it that answers `--version` with `answer`, and leaves a file if it gets a
/// job.
class TwoBuilds {
  public:
    explicit TwoBuilds(const std::string& answer) {
        std::filesystem::copy(path_of("clearway"), clearway());
        const std::string worker =
            folder_.write("clearway-run", "#!/bin/sh\nif [ \"$1\" = --version ]; then printf '" + answer +
                                              "'; else touch \"${0%/*}/worked\"; fi\n");
        std::filesystem::permissions(worker, std::filesystem::perms::owner_all);
    }
    std::string clearway() const { return folder_.path() / "clearway"; }
    std::string out() const { return folder_.path() / "out"; }
    bool worked() const { return std::filesystem::exists(folder_.path() / "worked"); }

  private:
    support::TemporaryFolder folder_;
};

TEST(ProgramsTest, a_worker_of_another_build_is_refused_before_anything_runs) {
    for (const std::string build : {"\\nbuild 0123456789abcdef\\n", "\\n"}) {
        const TwoBuilds two("clearway-run 0.1.0 with SUMO 1.15.0" + build);
        for (const std::vector<std::string>& words :
             {std::vector<std::string>{"run", "merge", "--seeds", "1", "--out", two.out()},
              std::vector<std::string>{"links", "dataset", "merge", "--seeds", "1", "--out", two.out()}}) {
            const Answer answer = call(two.clearway(), words, {{"CLEARWAY_HOME", CLEARWAY_SOURCE_DIR}});
            EXPECT_EQ(answer.exit.code, 4) << words[0];
            EXPECT_THAT(answer.text, AllOf(HasSubstr("/clearway-run: is of another build than this clearway"),
                                           HasSubstr("Build both programs together")));
        }
        EXPECT_FALSE(two.worked());
        const Answer doctor = call(two.clearway(), {"doctor"});
        EXPECT_EQ(doctor.exit.code, 4);
        EXPECT_THAT(doctor.text, testing::ContainsRegex(
                                     "UNFIT +clearway-run +.*, of another build\n +than this clearway: "));
    }
}

TEST(ProgramsTest, closed_streams_leave_a_run_as_it_is) {
    const support::TemporaryFolder folder;
    const auto record_of = [&](const std::string& name, const std::string& closing, int code) {
        const std::string out = folder.path() / name;
        const Answer answer = call("sh", {"-c", "exec \"$0\" \"$@\" " + closing, path_of("clearway"), "run",
                                          "merge", "--no-solo", "--seeds", "1", "--jobs", "1", "--out", out});
        EXPECT_EQ(answer.exit.code, code) << closing << answer.text;
        const std::string said = "standard output cannot be written";
        EXPECT_EQ(answer.text.find(said) != std::string::npos,
                  code != 0 && closing.find('2') == std::string::npos)
            << closing << answer.text;
        return core::read_file(out + "/runs/merge/corridor/00000/run.json");
    };
    const std::string expected = record_of("open", "", 0);
    EXPECT_EQ(record_of("no-errors", "2>&-", 0), expected);
    EXPECT_EQ(record_of("no-input", "<&- 2>&-", 0), expected);
    EXPECT_EQ(record_of("no-output", ">&-", 4), expected);
    EXPECT_EQ(record_of("nothing", "<&- >&- 2>&-", 4), expected);
    const auto page_of = [&](const std::string& closing) {
        const std::string run = folder.path() / "open";
        const Answer answer =
            call("sh", {"-c", "exec \"$0\" report \"$1\" " + closing, path_of("clearway"), run});
        EXPECT_TRUE(answer.exit.ok()) << answer.text;
        return core::read_file(run + "/report.html");
    };
    const std::string page = page_of("");
    EXPECT_EQ(page_of("2>&-"), page);
}

/// The stamp of a tree with these files.
std::string stamp_of(const std::vector<std::pair<std::string, std::string>>& files) {
    const support::TemporaryFolder folder;
    std::string names;
    for (const auto& [name, text] : files) {
        folder.write(name, text);
        names += name + "\n";
    }
    const std::string root = folder.path();
    const Answer answer = call(
        "cmake", {"-D", "OUTPUT=" + root + "/stamp.cpp", "-D", "LIST=" + folder.write("list", names).string(),
                  "-D", "ROOT=" + root, "-P", CLEARWAY_SOURCE_DIR "/cmake/build_stamp.cmake"});
    EXPECT_TRUE(answer.exit.ok()) << answer.text;
    return core::read_file(root + "/stamp.cpp");
}

TEST(ProgramsTest, a_build_is_told_by_names_and_contents_of_its_sources) {
    const std::string stamp = stamp_of({{"a.cpp", "one"}, {"b.cpp", "two"}});
    EXPECT_EQ(stamp_of({{"a.cpp", "one"}, {"b.cpp", "two"}}), stamp) << "elsewhere and later";
    EXPECT_NE(stamp_of({{"a.cpp", "one"}, {"b.cpp", "three"}}), stamp);
    EXPECT_NE(stamp_of({{"a.cpp", "one"}, {"c.cpp", "two"}}), stamp);
    EXPECT_NE(stamp_of({{"a.cpp", "one"}}), stamp);
}

TEST(ProgramsTest, the_worker_explains_a_wrong_call_and_exits_with_2) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{}, std::vector<std::string>{"--unit"},
          std::vector<std::string>{"city", "x"}}) {
        const Answer answer = call(path_of("clearway-run"), words);
        EXPECT_EQ(answer.exit.code, 2);
        EXPECT_THAT(answer.text, HasSubstr("clearway-run JOB.json"));
    }
}

TEST(ProgramsTest, the_worker_exits_with_3_for_a_job_it_cannot_read) {
    EXPECT_EQ(call(path_of("clearway-run"), {"/nowhere/job.json"}).exit.code, 3);
    const support::TemporaryFolder folder;
    const Answer answer = call(path_of("clearway-run"), {folder.write("job.json", R"({"kind": "fly"})")});
    EXPECT_EQ(answer.exit.code, 3);
    EXPECT_THAT(answer.text,
                AllOf(HasSubstr("\"fly\" is not known"), HasSubstr("run, dataset, links or attach")));
}

}  // namespace
}  // namespace clearway
