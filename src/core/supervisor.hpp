#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/interruption.hpp"
#include "core/process.hpp"

namespace clearway::core {

/// What one process may use, not counting children of its own.
struct ProcessLimits {
    double wall_s = std::numeric_limits<double>::infinity();
    long memory_mib = 0;  ///< Resident size; 0: no limit.
};

/// Work for one process.
struct Task {
    std::size_t id = 0;  ///< Comes back in TaskEnd.
    Command command;
    ProcessLimits limits = {};
};

/// Who ended a process.
enum class EndedBy : std::uint8_t { itself, time_limit, memory_limit, interruption };

/// How a process ended.
struct TaskEnd {
    std::size_t id = 0;
    Exit exit;
    EndedBy ended_by = EndedBy::itself;
};

/// What a supervisor asks and tells. An exception that leaves one of these ends all processes.
class TaskList {
  public:
    TaskList() = default;
    virtual ~TaskList() = default;
    TaskList(const TaskList&) = delete;
    TaskList& operator=(const TaskList&) = delete;

    /// The next task to start; nothing when there is none now. Asked again after each end.
    virtual std::optional<Task> next() = 0;
    /// A process has ended, also when an interruption ended it. May give `next` more to answer.
    virtual void ended(const TaskEnd& end) = 0;
    /// Called about fifty times a second with the tasks whose processes run.
    virtual void tick(std::span<const std::size_t> running) = 0;
};

struct SupervisorConfig {
    std::size_t processes = 0;  ///< At one time; 0: one per core.
    double grace_s = 5.0;       ///< From SIGTERM to SIGKILL. Assumed: a worker closes its files in less.
};

/// Which limit a running child is over; `itself` when it is over none.
EndedBy limit_passed_by(const Child& child, const ProcessLimits& limits);

/// Runs child processes side by side. Limits are looked at 20 times a second. A
/// process over one gets SIGTERM, and SIGKILL when it still lives
/// after the grace. None outlives the supervisor. One thread.
class Supervisor {
  public:
    explicit Supervisor(SupervisorConfig config);
    ~Supervisor();
    Supervisor(const Supervisor&) = delete;
    Supervisor& operator=(const Supervisor&) = delete;

    /// Works until the list has nothing left and no process runs, or until a signal comes: then all processes
    /// are ended. Throws core::EnvironmentError when no process can be started.
    void run(TaskList& tasks, const InterruptionWatch& interruption);

  private:
    using Clock = std::chrono::steady_clock;
    struct Running {
        std::size_t id = 0;
        Child child;
        ProcessLimits limits;
        EndedBy ended_by = EndedBy::itself;
        std::optional<Clock::time_point> terminated;  ///< When SIGTERM was sent.
    };
    void start_what_fits(TaskList& tasks);
    /// Ends processes over their limits, and answers those that ended since the last call.
    std::vector<TaskEnd> collect();
    void enforce_limits(Running& running, bool look_now) const;
    bool look_is_due();
    /// Returns when no process is left.
    std::vector<TaskEnd> end_all();

    SupervisorConfig config_;
    std::vector<Running> running_;
    Clock::time_point looked_{};
};

/// `processes`, or the number of cores for 0.
std::size_t process_count(std::size_t processes);

}  // namespace clearway::core
