#include "core/supervisor.hpp"

#include <algorithm>
#include <csignal>
#include <exception>
#include <thread>

namespace clearway::core {
namespace {

constexpr double look_period_s = 0.05;

double seconds_between(Machine::Clock::time_point start, Machine::Clock::time_point end) {
    return std::chrono::duration<double>(end - start).count();
}

class ThisMachine : public Machine {
  public:
    Clock::time_point now() override { return Clock::now(); }
    void pause() override { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }
    Child start(const Command& command) override { return core::start(command); }
    std::optional<Exit> poll(const Child& child) override { return core::poll(child); }
    std::optional<long> resident_kib(const Child& child) override { return core::resident_kib(child.pid); }
    void kill(const Child& child, int signal) override { ::kill(child.pid, signal); }
};

}  // namespace

std::size_t process_count(std::size_t processes) {
    return processes > 0 ? processes : std::max(1U, std::thread::hardware_concurrency());
}

Machine& this_machine() {
    static ThisMachine machine;
    return machine;
}

EndedBy limit_passed_by(const Child& child, const ProcessLimits& limits, Machine& machine) {
    if (seconds_between(child.started, machine.now()) > limits.wall_s) return EndedBy::time_limit;
    const long most_kib = limits.memory_mib * 1024;
    if (most_kib > 0 && machine.resident_kib(child).value_or(0) > most_kib) return EndedBy::memory_limit;
    return EndedBy::itself;
}

double Supervisor::seconds_since(Clock::time_point start) const {
    return seconds_between(start, machine_.now());
}

Supervisor::Supervisor(SupervisorConfig config, Machine& machine) : config_(config), machine_(machine) {
    config_.processes = process_count(config.processes);
}

Supervisor::~Supervisor() {
    try {
        end_all();
    } catch (const std::exception&) {
        // A destructor cannot report this. The children get SIGTERM when this process ends.
    }
}

void Supervisor::run(TaskList& tasks, const InterruptionWatch& interruption) {
    while (interruption.signal() == 0) {
        start_what_fits(tasks);
        if (running_.empty()) return;
        for (TaskEnd end : collect()) {
            // A signal from the terminal reaches children and parent alike.
            if (interruption.signal() != 0 && end.exit.signal != 0) end.ended_by = EndedBy::interruption;
            tasks.ended(end);
        }
        std::vector<std::size_t> ids;
        for (const Running& running : running_)
            ids.push_back(running.id);
        tasks.tick(ids);
        machine_.pause();
    }
    for (const TaskEnd& end : end_all())
        tasks.ended(end);
}

void Supervisor::start_what_fits(TaskList& tasks) {
    while (running_.size() < config_.processes) {
        const std::optional<Task> task = tasks.next();
        if (!task) return;
        running_.push_back(
            {task->id, machine_.start(task->command), task->limits, EndedBy::itself, std::nullopt});
    }
}

bool Supervisor::look_is_due() {
    if (seconds_since(looked_) < look_period_s) return false;
    looked_ = machine_.now();
    return true;
}

void Supervisor::enforce_limits(Running& running, bool look_now) const {
    if (running.terminated) {
        if (seconds_since(*running.terminated) > config_.grace_s) machine_.kill(running.child, SIGKILL);
        return;
    }
    if (!look_now) return;
    running.ended_by = limit_passed_by(running.child, running.limits, machine_);
    if (running.ended_by == EndedBy::itself) return;
    running.terminated = machine_.now();
    machine_.kill(running.child, SIGTERM);
}

std::vector<TaskEnd> Supervisor::collect() {
    std::vector<TaskEnd> ended;
    const bool look_now = look_is_due();
    std::erase_if(running_, [&](Running& running) {
        enforce_limits(running, look_now);
        const std::optional<Exit> exit = machine_.poll(running.child);
        if (exit) ended.push_back({running.id, *exit, running.ended_by});
        return exit.has_value();
    });
    return ended;
}

std::vector<TaskEnd> Supervisor::end_all() {
    for (Running& running : running_) {
        if (running.terminated) continue;
        running.terminated = machine_.now();
        running.ended_by = EndedBy::interruption;
        machine_.kill(running.child, SIGTERM);
    }
    std::vector<TaskEnd> ended;
    while (!running_.empty()) {
        for (TaskEnd end : collect()) {
            if (end.exit.ok()) end.ended_by = EndedBy::itself;  // It had finished its work.
            ended.push_back(end);
        }
        if (!running_.empty()) machine_.pause();
    }
    return ended;
}

}  // namespace clearway::core
