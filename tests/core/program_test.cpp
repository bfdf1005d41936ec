#include "core/program.hpp"

#include <cerrno>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

namespace clearway::core {
namespace {

using testing::HasSubstr;

struct Ended {
    ExitCode code;
    std::string said;
};

template <class Act>
Ended end(const Act& act, ExitCode of_bug = ExitCode::environment) {
    testing::internal::CaptureStderr();
    const ExitCode code = end_of("clearway-run", act, of_bug);
    return {code, testing::internal::GetCapturedStderr()};
}

template <class Fault>
auto throwing(const Fault& fault) {
    return [fault]() -> ExitCode { throw fault; };
}

TEST(Program, EndsWithTheCodeOfWhatItThrowsAndSaysIt) {
    EXPECT_EQ(end([] { return ExitCode::fell_short; }).code, ExitCode::fell_short);
    const Ended input = end(throwing(InputError(Problem{"a.toml", "is b", "", ""})));
    EXPECT_EQ(input.code, ExitCode::bad_input);
    EXPECT_EQ(input.said, "clearway-run: a.toml: is b\n");
    const Ended memory = end(throwing(std::bad_alloc()));
    EXPECT_EQ(memory.code, ExitCode::environment);
    EXPECT_THAT(memory.said, HasSubstr("out of memory"));
    const std::error_code denied(EACCES, std::system_category());
    const Ended folder = end(throwing(std::filesystem::filesystem_error("status", "/x/y", denied)));
    EXPECT_EQ(folder.code, ExitCode::environment);
    EXPECT_THAT(folder.said, HasSubstr("/x/y"));
    const Ended bug = end(throwing(std::out_of_range("map::at")), ExitCode::runs_failed);
    EXPECT_EQ(bug.code, ExitCode::runs_failed);
    EXPECT_EQ(bug.said, "clearway-run: map::at\n");
}

TEST(Program, KeepsItsCodeWhereStandardErrorCannotBeWritten) {
    const int kept = ::dup(STDERR_FILENO);
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ASSERT_GE(full, 0);
    ::dup2(full, STDERR_FILENO);
    const ExitCode code = end_of("clearway-run", throwing(std::runtime_error("a long story")));
    ::dup2(kept, STDERR_FILENO);
    ::close(full);
    ::close(kept);
    EXPECT_EQ(code, ExitCode::environment);
}

}  // namespace
}  // namespace clearway::core
