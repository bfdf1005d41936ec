#include "study/detail/worker_pool.hpp"

#include <csignal>
#include <thread>

namespace clearway::study::detail {
namespace {

constexpr double memory_period_s = 0.05;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

WorkerPool::~WorkerPool() {
    try {
        end_all();
    } catch (const std::exception&) {
        // Nobody is left to tell; the children get SIGTERM when this process ends.
    }
}

std::vector<std::size_t> WorkerPool::jobs() const {
    std::vector<std::size_t> result;
    for (const Running& running : running_)
        result.push_back(running.job);
    return result;
}

void WorkerPool::start(std::size_t job, const core::Command& command, const ChildLimits& limits) {
    running_.push_back({job, core::start(command), limits, EndedBy::itself, std::nullopt});
}

bool WorkerPool::memory_is_due() {
    if (seconds_since(looked_at_memory_) < memory_period_s) return false;
    looked_at_memory_ = Clock::now();
    return true;
}

void WorkerPool::enforce_limits(Running& running, bool look_at_memory) const {
    const auto over = [&] {
        if (seconds_since(running.child.started) > running.limits.wall_s) return EndedBy::time_limit;
        const long most_kib = running.limits.memory_mib * 1024;
        if (look_at_memory && most_kib > 0 && core::resident_kib(running.child.pid).value_or(0) > most_kib)
            return EndedBy::memory_limit;
        return EndedBy::itself;
    };
    if (!running.terminated) {
        running.ended_by = over();
        if (running.ended_by == EndedBy::itself) return;
        running.terminated = Clock::now();
        ::kill(running.child.pid, SIGTERM);
    } else if (seconds_since(*running.terminated) > limits_.grace_s) {
        ::kill(running.child.pid, SIGKILL);
    }
}

std::vector<WorkerEnd> WorkerPool::collect() {
    std::vector<WorkerEnd> ended;
    const bool look_at_memory = memory_is_due();
    std::erase_if(running_, [&](Running& running) {
        enforce_limits(running, look_at_memory);
        const std::optional<core::Exit> exit = core::poll(running.child);
        if (exit) ended.push_back({running.job, *exit, running.ended_by});
        return exit.has_value();
    });
    return ended;
}

void WorkerPool::end_all() {
    for (Running& running : running_) {
        running.terminated = Clock::now();
        ::kill(running.child.pid, SIGTERM);
    }
    while (!running_.empty()) {
        collect();
        if (!running_.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
}

}  // namespace clearway::study::detail
