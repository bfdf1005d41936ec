#include "loop/watch.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>

#include <fmt/format.h>
#include <sys/wait.h>

#include "core/error.hpp"

namespace clearway::loop {
namespace {

constexpr timespec look_period{.tv_sec = 0, .tv_nsec = 50'000'000};

sigset_t watched_signals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGCHLD, SIGINT, SIGTERM})
        sigaddset(&set, signal);
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
    const sigset_t set = watched_signals();
    sigprocmask(SIG_BLOCK, &set, nullptr);
}

ChildSignals::~ChildSignals() {
    release();
}

void ChildSignals::release() {
    const sigset_t set = watched_signals();
    sigprocmask(SIG_UNBLOCK, &set, nullptr);
}

WatchedEnd watch(pid_t child, const experiment::RunLimits& limits) {
    const core::Child watched{child, std::chrono::steady_clock::now()};
    const core::ProcessLimits allowed{.wall_s = limits.wall_s, .memory_mib = limits.memory_mib};
    const sigset_t set = watched_signals();
    WatchedEnd end;
    while (!has_ended(child, end.status)) {
        const int signal = sigtimedwait(&set, nullptr, &look_period);
        if (signal == SIGINT || signal == SIGTERM) {
            end.interruption = signal;
            ::kill(child, signal);
        }
        if (end.by != core::EndedBy::itself) continue;
        end.by = core::limit_passed_by(watched, allowed);
        if (end.by != core::EndedBy::itself) ::kill(child, SIGKILL);
    }
    return end;
}

}  // namespace clearway::loop
