#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/process.hpp"

namespace clearway::study::detail {

/// How a worker ended.
struct WorkerEnd {
    std::size_t job = 0;
    core::Exit exit;
    bool timed_out = false;
};

struct PoolLimits {
    std::size_t workers = 1;
    double time_limit_s = 3600.0;
    double grace_s = 5.0;  ///< From SIGTERM to SIGKILL.
};

/// Child processes with a time limit each. No child outlives the pool.
class WorkerPool {
  public:
    explicit WorkerPool(PoolLimits limits) : limits_(limits) {}
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    bool full() const { return running_.size() >= limits_.workers; }
    bool idle() const { return running_.empty(); }
    /// Jobs of the children that run.
    std::vector<std::size_t> jobs() const;
    /// `job` comes back in WorkerEnd.
    void start(std::size_t job, const core::Command& command);
    /// Ends children over their time, and answers those that ended since the last call.
    std::vector<WorkerEnd> collect();
    /// SIGTERM to all, SIGKILL after the grace; returns when none is left.
    void end_all();

  private:
    using Clock = std::chrono::steady_clock;
    struct Running {
        std::size_t job = 0;
        core::Child child;
        bool timed_out = false;
        std::optional<Clock::time_point> terminated;  ///< When SIGTERM was sent.
    };
    void enforce_limit(Running& running) const;

    PoolLimits limits_;
    std::vector<Running> running_;
};

}  // namespace clearway::study::detail
