#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/process.hpp"

namespace clearway::study::detail {

/// Who ended a worker.
enum class EndedBy : std::uint8_t { itself, time_limit, memory_limit };

/// How a worker ended.
struct WorkerEnd {
    std::size_t job = 0;
    core::Exit exit;
    EndedBy ended_by = EndedBy::itself;
};

struct PoolLimits {
    std::size_t workers = 1;
    double grace_s = 5.0;  ///< From SIGTERM to SIGKILL.
};

/// What one child may use, not counting children of its own.
struct ChildLimits {
    double wall_s = 3600.0;
    long memory_mib = 0;  ///< Resident size; 0: no limit.
};

/// Child processes with limits each. No child outlives the pool.
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
    void start(std::size_t job, const core::Command& command, const ChildLimits& limits);
    /// Ends children over their limits, and answers those that ended since the last call.
    std::vector<WorkerEnd> collect();
    /// SIGTERM to all, SIGKILL after the grace; returns when none is left.
    void end_all();

  private:
    using Clock = std::chrono::steady_clock;
    struct Running {
        std::size_t job = 0;
        core::Child child;
        ChildLimits limits;
        EndedBy ended_by = EndedBy::itself;
        std::optional<Clock::time_point> terminated;  ///< When SIGTERM was sent.
    };
    void enforce_limits(Running& running, bool look_at_memory) const;
    bool memory_is_due();

    PoolLimits limits_;
    std::vector<Running> running_;
    Clock::time_point looked_at_memory_{};
};

}  // namespace clearway::study::detail
