#include "loop/copy_of_run.hpp"

#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

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
[[noreturn]] void be_copy(const std::filesystem::path& folder, const std::function<void()>& drive,
                          const void* answer, std::size_t size, int pipe) {
    bool is_found = false;
    try {
        core::make_folder(folder);
        drive();
        is_found = true;
    } catch (const std::exception& error) {
        core::complain("a copy of the run", error);
    }
    std::fflush(nullptr);
    _exit(is_found && ::write(pipe, answer, size) == static_cast<ssize_t>(size) ? 0 : 1);
}

}  // namespace

namespace detail {

void in_copy(const std::filesystem::path& folder, const std::function<void()>& drive, void* answer,
             std::size_t size) {
    assert(size <= PIPE_BUF && "it is written and read at once");
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
        be_copy(folder, drive, answer, size, ends[1]);
    }
    ::close(ends[1]);
    ssize_t got = 0;
    do {
        got = ::read(ends[0], answer, size);
    } while (got < 0 && errno == EINTR);
    ::close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    if (got != static_cast<ssize_t>(size))
        throw core::SimulatorError("a copy of the run that tried another choice did not come to its end");
}

}  // namespace detail

}  // namespace clearway::loop
