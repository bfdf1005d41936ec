#include "loop/copy_of_run.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <limits>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/program.hpp"
#include "core/read_failure.hpp"

namespace clearway::loop {
namespace {

/// Everything of a copy but its number. Never returns, because objects of the parent must not be destroyed
/// twice.
[[noreturn]] void be_copy(const std::filesystem::path& folder, const std::function<core::Seconds()>& drive,
                          int answer) {
    double found_s = std::numeric_limits<double>::quiet_NaN();
    try {
        core::make_folder(folder);
        found_s = drive().value;
    } catch (const std::exception& error) {
        core::complain("a copy of the run", error);
    }
    std::fflush(nullptr);
    const ssize_t written = ::write(answer, &found_s, sizeof found_s);
    _exit(written == sizeof found_s ? 0 : 1);
}

}  // namespace

core::Seconds in_copy(const std::filesystem::path& folder, const std::function<core::Seconds()>& drive) {
    int ends[2];
    if (pipe(ends) != 0)
        throw core::EnvironmentError(
            fmt::format("cannot copy the run: {}. {}", std::strerror(errno), core::cure_of(errno)));
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) {
        ::close(ends[0]);
        ::close(ends[1]);
        throw core::EnvironmentError(
            fmt::format("cannot fork to copy the run: {}. {}", std::strerror(errno), core::cure_of(errno)));
    }
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        be_copy(folder, drive, ends[1]);
    }
    ::close(ends[1]);
    double found_s = std::numeric_limits<double>::quiet_NaN();
    ssize_t got = 0;
    do {
        got = ::read(ends[0], &found_s, sizeof found_s);
    } while (got < 0 && errno == EINTR);
    ::close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    if (got != sizeof found_s || !(found_s == found_s))
        throw core::SimulatorError(
            "a copy of the run that tried another way or unit did not come to its end");
    return core::Seconds(found_s);
}

}  // namespace clearway::loop
