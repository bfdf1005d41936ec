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

/// What one process may use; its own children are not counted.
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

/// What ended a process.
enum class EndedBy : std::uint8_t { itself, time_limit, memory_limit, interruption };

/// How a process ended.
struct TaskEnd {
    std::size_t id = 0;
    Exit exit;
    EndedBy ended_by = EndedBy::itself;
};

/// The tasks of a supervisor and its callbacks. An exception thrown from one of them ends all processes.
class TaskList {
  public:
    TaskList() = default;
    virtual ~TaskList() = default;
    TaskList(const TaskList&) = delete;
    TaskList& operator=(const TaskList&) = delete;

    /// The next task to start; nothing when there is none at present. Called again while a process slot is
    /// free.
    virtual std::optional<Task> next() = 0;
    /// A process has ended, possibly through a limit or an interruption. `next` may return further tasks
    /// afterwards.
    virtual void ended(const TaskEnd& end) = 0;
    /// Called about a hundred times a second with the ids of the running tasks.
    virtual void tick(std::span<const std::size_t> running) = 0;
};

struct SupervisorConfig {
    std::size_t processes = 0;  ///< At the same time; 0: one per core.
    double grace_s = 5.0;       ///< From SIGTERM to SIGKILL. Assumed: a worker closes its files sooner.
};

/// Clock and processes, in whose place tests put their own.
class Machine {
  public:
    using Clock = std::chrono::steady_clock;
    Machine() = default;
    virtual ~Machine() = default;
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    virtual Clock::time_point now() = 0;
    /// Some hundredths of a second.
    virtual void pause() = 0;
    /// As the functions of process.hpp.
    virtual Child start(const Command& command) = 0;
    virtual std::optional<Exit> poll(const Child& child) = 0;
    virtual std::optional<long> resident_kib(const Child& child) = 0;
    virtual void kill(const Child& child, int signal) = 0;
};
Machine& this_machine();

/// Which limit a running child exceeds; `itself` when it exceeds none.
EndedBy limit_passed_by(const Child& child, const ProcessLimits& limits, Machine& machine = this_machine());

/// Runs child processes in parallel. Limits are checked 20 times a second: a process over a limit gets
/// SIGTERM, and SIGKILL if it is still running after the grace period. No process outlives the supervisor.
/// For use by one thread.
class Supervisor {
  public:
    explicit Supervisor(SupervisorConfig config, Machine& machine = this_machine());
    ~Supervisor();
    Supervisor(const Supervisor&) = delete;
    Supervisor& operator=(const Supervisor&) = delete;

    /// Returns when no task is left and no process runs, or after a signal, which ends all processes. Throws
    /// core::EnvironmentError when no process can be started.
    void run(TaskList& tasks, const InterruptionWatch& interruption);

  private:
    using Clock = Machine::Clock;
    struct Running {
        std::size_t id = 0;
        Child child;
        ProcessLimits limits;
        EndedBy ended_by = EndedBy::itself;
        std::optional<Clock::time_point> terminated;  ///< When SIGTERM was sent.
    };
    void start_what_fits(TaskList& tasks);
    /// Ends processes over their limits, and returns those that ended since the last call.
    std::vector<TaskEnd> collect();
    void enforce_limits(Running& running, bool look_now) const;
    bool look_is_due();
    double seconds_since(Clock::time_point start) const;
    /// Ends all processes and waits for them.
    std::vector<TaskEnd> end_all();

    SupervisorConfig config_;
    Machine& machine_;
    std::vector<Running> running_;
    Clock::time_point looked_{};
};

/// `processes`, or the number of cores for 0.
std::size_t process_count(std::size_t processes);

}  // namespace clearway::core
