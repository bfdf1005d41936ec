#include "core/supervisor.hpp"

#include <algorithm>
#include <cerrno>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/files.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::core {
namespace {

using namespace std::chrono_literals;

/// Neither this shell nor what it starts ends at SIGTERM. Writes its process number first.
constexpr const char* stubborn = "trap '' TERM; echo $$; while :; do sleep 0.02; done";

bool is_alive(pid_t process) {
    return ::kill(process, 0) == 0 || errno != ESRCH;
}

/// Shell scripts, one process each.
class Scripts : public TaskList {
  public:
    explicit Scripts(std::vector<std::string> scripts) : scripts_(std::move(scripts)) {}

    std::optional<Task> next() override {
        if (next_ == scripts_.size()) return std::nullopt;
        const Command command{.program = "sh", .arguments = {"-c", scripts_[next_]}, .output = output(next_)};
        return Task{next_++, command, limits};
    }
    void ended(const TaskEnd& end) override {
        ends[end.id] = end;
        if (on_end) on_end(end);
    }
    void tick(std::span<const std::size_t> running) override {
        most_running = std::max(most_running, running.size());
        if (on_tick) on_tick();
    }

    std::filesystem::path output(std::size_t id) const { return folder_.path() / std::to_string(id); }
    /// What the script wrote, once it has written a line.
    std::string line_of(std::size_t id) const {
        const std::string text = std::filesystem::exists(output(id)) ? read_file(output(id)) : "";
        return text.ends_with('\n') ? text.substr(0, text.size() - 1) : "";
    }

    ProcessLimits limits;
    std::map<std::size_t, TaskEnd> ends;
    std::size_t most_running = 0;
    std::function<void(const TaskEnd&)> on_end;
    std::function<void()> on_tick;

  private:
    support::TemporaryFolder folder_;
    std::vector<std::string> scripts_;
    std::size_t next_ = 0;
};

TEST(Supervisor, RunsAllTasksButNeverMoreThanAllowedAtOnce) {
    const InterruptionWatch interruption;
    Scripts scripts({"sleep 0.05", "sleep 0.05; exit 3", "sleep 0.05", "kill -SEGV $$", "sleep 0.05"});
    Supervisor({.processes = 2}).run(scripts, interruption);
    ASSERT_EQ(scripts.ends.size(), 5U);
    EXPECT_EQ(scripts.ends.at(1).exit.code, 3);
    EXPECT_EQ(scripts.ends.at(3).exit.signal, SIGSEGV);
    for (const auto& [id, end] : scripts.ends)
        EXPECT_EQ(end.ended_by, EndedBy::itself) << id;
    EXPECT_EQ(scripts.most_running, 2U);
    EXPECT_EQ(interruption.exit_code(ExitCode::ok), ExitCode::ok);
}

TEST(Supervisor, KillsAChildThatIgnoresSigtermAfterTheGrace) {
    const InterruptionWatch interruption;
    Scripts scripts({stubborn, "exit 0"});
    scripts.limits.wall_s = 0.2;
    Supervisor({.processes = 2, .grace_s = 0.2}).run(scripts, interruption);
    EXPECT_EQ(scripts.ends.at(0).ended_by, EndedBy::time_limit);
    EXPECT_EQ(scripts.ends.at(0).exit.signal, SIGKILL);
    EXPECT_GE(scripts.ends.at(0).exit.wall_s, 0.4) << "the grace was not given";
    EXPECT_TRUE(scripts.ends.at(1).exit.ok());
}

TEST(Supervisor, EndsAChildThatHoldsTooMuchMemory) {
    const InterruptionWatch interruption;
    // A shell's variable of 100 MB.
    Scripts scripts(
        {"x=$(head -c 100000000 /dev/zero | tr '\\0' x); sleep 60 > /dev/null 2>&1", "sleep 0.2"});
    scripts.limits.memory_mib = 50;
    Supervisor({.processes = 2, .grace_s = 0.2}).run(scripts, interruption);
    EXPECT_EQ(scripts.ends.at(0).ended_by, EndedBy::memory_limit);
    EXPECT_TRUE(scripts.ends.at(1).exit.ok());
}

TEST(Supervisor, AnInterruptionEndsAllChildrenAlsoStubbornOnes) {
    const InterruptionWatch interruption;
    Scripts scripts({stubborn, "echo $$; exec sleep 60", "exit 0"});
    scripts.on_tick = [&] {
        if (!scripts.line_of(0).empty() && !scripts.line_of(1).empty()) ::kill(::getpid(), SIGINT);
    };
    Supervisor({.processes = 2, .grace_s = 0.2}).run(scripts, interruption);
    EXPECT_EQ(interruption.signal(), SIGINT);
    EXPECT_EQ(interruption.exit_code(ExitCode::runs_failed), ExitCode::interrupted);
    ASSERT_EQ(scripts.ends.size(), 2U) << "the third must not start any more";
    for (const std::size_t id : {0, 1}) {
        EXPECT_EQ(scripts.ends.at(id).ended_by, EndedBy::interruption);
        EXPECT_FALSE(is_alive(std::stoi(scripts.line_of(id))));
    }
    EXPECT_EQ(scripts.ends.at(0).exit.signal, SIGKILL);
    EXPECT_EQ(scripts.ends.at(1).exit.signal, SIGTERM);
}

TEST(Supervisor, LeavesNoChildBehindWhenItsUserThrows) {
    const InterruptionWatch interruption;
    Scripts scripts({stubborn, "sleep 0.1"});
    scripts.on_end = [](const TaskEnd&) { throw EnvironmentError("full disk"); };
    EXPECT_THROW(Supervisor({.processes = 2, .grace_s = 0.1}).run(scripts, interruption), EnvironmentError);
    EXPECT_FALSE(is_alive(std::stoi(scripts.line_of(0))));
}

TEST(InterruptionWatch, KeepsTheFirstSignalAndGivesTheHandlersBack) {
    struct sigaction before {};
    sigaction(SIGTERM, nullptr, &before);
    {
        const InterruptionWatch watch;
        std::raise(SIGTERM);
        std::raise(SIGINT);
        EXPECT_EQ(watch.signal(), SIGTERM);
        EXPECT_EQ(watch.exit_code(ExitCode::ok), ExitCode::terminated);
    }
    struct sigaction after {};
    sigaction(SIGTERM, nullptr, &after);
    EXPECT_EQ(before.sa_handler, after.sa_handler);
    EXPECT_EQ(InterruptionWatch().signal(), 0);
}

}  // namespace
}  // namespace clearway::core
