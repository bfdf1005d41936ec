#include "scenario_import/detail/tool.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/process.hpp"
#include "core/read_failure.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// Ends a child process that nobody waits for any more.
class ChildGuard {
  public:
    explicit ChildGuard(const core::Child& child) : child_(child) {}
    ~ChildGuard() {
        if (!running) return;
        ::kill(child_.pid, SIGKILL);
        core::wait(child_);
    }
    ChildGuard(const ChildGuard&) = delete;
    ChildGuard& operator=(const ChildGuard&) = delete;
    bool running = true;

  private:
    const core::Child& child_;
};

}  // namespace

bool succeeds(const Tool& tool, const OnProgress& on_progress) {
    core::Command command;
    command.program = tool.program;
    command.arguments = tool.arguments;
    command.output = tool.log;
    // They get absolute paths; whatever they write without a path must land in the work folder too.
    if (tool.program == "sumo" || tool.program == "duarouter") command.folder = tool.log.parent_path();
    const core::Child child = core::start(command);
    ChildGuard guard(child);
    std::optional<core::Exit> exit;
    while (!(exit = core::poll(child))) {
        const auto elapsed = std::chrono::steady_clock::now() - child.started;
        on_progress(tool.stage, std::chrono::duration<double>(elapsed).count());
        if (tool.is_enough && tool.is_enough()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    guard.running = false;
    constexpr int not_found = 127;
    if (exit->code == not_found)
        throw core::EnvironmentError(fmt::format(
            "{} does not start. Install the package {}, or give the same command again if the machine failed",
            tool.program, tool.package));
    if (exit->signal == SIGKILL)  // so the system ends it where memory is short
        throw core::EnvironmentError(fmt::format("{} was {}. The machine failed: give the same command again",
                                                 tool.program, exit->describe()));
    return exit->ok();
}

std::string complaint(const std::filesystem::path& log) {
    constexpr int shown = 8;
    std::ifstream stream(log);
    std::string errors;
    int count = 0;
    for (std::string line; std::getline(stream, line) && count < shown;) {
        if (!line.starts_with("Error")) continue;
        errors += (errors.empty() ? "" : "\n") + line;
        ++count;
    }
    if (errors.empty()) errors = core::tail(log, shown);
    if (core::tells_of_machine(errors))
        throw core::EnvironmentError(fmt::format("{}:\n{}\nThe machine failed: give the same command again",
                                                 log.filename().string(), errors));
    return errors;
}

}  // namespace clearway::scenario_import::detail
