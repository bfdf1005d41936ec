#include "loop/watch.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

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

/// Resident memory of a run and of its parts in Python. These are children of another process; they have the
/// run's number in their name (python/clearway/_host.py).
class RunMemory {
  public:
    explicit RunMemory(pid_t run) : run_(run) {}

    long kib() {
        if (looks_++ % looks_per_search == 0) find_parts();
        long sum = core::resident_kib(run_).value_or(0);
        for (const std::string& part : parts_)
            sum += core::resident_kib(std::atoi(part.c_str())).value_or(0);
        return sum;
    }

  private:
    static constexpr int looks_per_search = 10;  // twice a second: a search takes some ms

    void find_parts() {
        parts_.clear();
        std::error_code none;
        for (auto entry = std::filesystem::directory_iterator("/proc", none);
             !none && entry != std::filesystem::directory_iterator(); entry.increment(none)) {
            std::string name;
            if (std::ifstream(entry->path() / "comm") >> name && name == fmt::format("part-{}", run_))
                parts_.push_back(entry->path().filename().string());
        }
    }

    pid_t run_;
    int looks_ = 0;
    std::vector<std::string> parts_;
};

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
    const core::ProcessLimits allowed{.wall_s = limits.wall_s};
    RunMemory memory(child);
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
        if (limits.memory_mib > 0 && memory.kib() > limits.memory_mib * 1024)
            end.by = core::EndedBy::memory_limit;
        if (end.by != core::EndedBy::itself) ::kill(child, SIGKILL);
    }
    return end;
}

}  // namespace clearway::loop
