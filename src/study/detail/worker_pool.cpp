#include "study/detail/worker_pool.hpp"

#include <csignal>
#include <thread>

namespace clearway::study::detail {
namespace {

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

void WorkerPool::start(std::size_t job, const core::Command& command) {
    running_.push_back({job, core::start(command), false, std::nullopt});
}

void WorkerPool::enforce_limit(Running& running) const {
    if (!running.terminated && seconds_since(running.child.started) > limits_.time_limit_s) {
        running.timed_out = true;
        running.terminated = Clock::now();
        ::kill(running.child.pid, SIGTERM);
    } else if (running.terminated && seconds_since(*running.terminated) > limits_.grace_s) {
        ::kill(running.child.pid, SIGKILL);
    }
}

std::vector<WorkerEnd> WorkerPool::collect() {
    std::vector<WorkerEnd> ended;
    std::erase_if(running_, [&](Running& running) {
        enforce_limit(running);
        const std::optional<core::Exit> exit = core::poll(running.child);
        if (exit) ended.push_back({running.job, *exit, running.timed_out});
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
