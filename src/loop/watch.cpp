#include "loop/watch.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
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

/// Resident memory of a run, of its parts in Python and of all that these started. The parts are children of
/// another process; they have the run's number in their name (python/clearway/_host.py).
class RunMemory {
  public:
    explicit RunMemory(pid_t run) : run_(run) {}

    long kib() {
        if (looks_++ % looks_per_search == 0) find_all();
        long sum = 0;
        for (const pid_t process : all_)
            sum += core::resident_kib(process).value_or(0);
        return sum;
    }

  private:
    static constexpr int looks_per_search = 10;  // twice a second: a search takes some ms

    void find_all() {
        all_ = {run_};
        std::multimap<pid_t, pid_t> children;
        std::error_code none;
        for (auto entry = std::filesystem::directory_iterator("/proc", none);
             !none && entry != std::filesystem::directory_iterator(); entry.increment(none)) {
            // `PID (NAME) STATE PARENT ...`; a name may hold blanks and brackets.
            std::string line;
            if (!std::getline(std::ifstream(entry->path() / "stat"), line)) continue;
            const pid_t process = std::atoi(line.c_str());
            const std::size_t end = line.rfind(')');
            if (end == std::string::npos || end + 4 > line.size()) continue;
            if (line.find(fmt::format("(part-{})", run_)) != std::string::npos) all_.push_back(process);
            children.emplace(std::atoi(line.c_str() + end + 4), process);
        }
        for (std::size_t parent = 0; parent < all_.size(); ++parent) {
            for (auto [child, last] = children.equal_range(all_[parent]); child != last; ++child)
                if (!core::contains(all_, child->second)) all_.push_back(child->second);
        }
    }

    pid_t run_;
    int looks_ = 0;
    std::vector<pid_t> all_;
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
