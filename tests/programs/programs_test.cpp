// The three programs: what each is linked to, and how it answers a wrong call.
#include <filesystem>
#include <string>
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

Answer call(const std::string& program, const std::vector<std::string>& arguments) {
    const support::TemporaryFolder folder;
    const std::filesystem::path log = folder.path() / "log.txt";
    const core::Exit exit = core::run({program, arguments, {}, log});
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
    EXPECT_THAT(libraries_of("clearway-train"), AllOf(HasSubstr("libtorch"), Not(HasSubstr("libsumo"))));
}

TEST(ProgramsTest, the_worker_tells_both_versions) {
    const Answer answer = call(path_of("clearway-run"), {"--version"});
    EXPECT_TRUE(answer.exit.ok());
    EXPECT_THAT(answer.text, testing::MatchesRegex("clearway-run [0-9.]+ with SUMO [0-9.]+\n"));
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
