#include "loop/watch.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>

#include <fmt/format.h>
#include <sys/wait.h>

#include "core/error.hpp"
#include "core/process.hpp"

namespace clearway::loop {
namespace {

constexpr timespec look_period{.tv_sec = 0, .tv_nsec = 50'000'000};

sigset_t child_ended() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGCHLD);
    return set;
}

bool has_ended(pid_t child, int& status) {
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR)
        throw core::EnvironmentError(fmt::format("cannot wait for process {}", child));
    return ended == child;
}

}  // namespace

ChildSignals::ChildSignals() {
    const sigset_t set = child_ended();
    sigprocmask(SIG_BLOCK, &set, nullptr);
}

ChildSignals::~ChildSignals() {
    const sigset_t set = child_ended();
    sigprocmask(SIG_UNBLOCK, &set, nullptr);
}

WatchedEnd watch(pid_t child, const experiment::RunLimits& limits) {
    const auto started = std::chrono::steady_clock::now();
    const sigset_t set = child_ended();
    WatchedEnd end;
    while (!has_ended(child, end.status)) {
        sigtimedwait(&set, nullptr, &look_period);
        if (end.by != WatchedEnd::By::itself) continue;
        const double wall_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
        if (wall_s > limits.wall_s) end.by = WatchedEnd::By::wall_limit;
        if (limits.memory_mib > 0 && core::resident_kib(child).value_or(0) > limits.memory_mib * 1024)
            end.by = WatchedEnd::By::memory_limit;
        if (end.by != WatchedEnd::By::itself) ::kill(child, SIGKILL);
    }
    return end;
}

}  // namespace clearway::loop
