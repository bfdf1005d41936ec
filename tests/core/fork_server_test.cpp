#include "core/fork_server.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::core {
namespace {

constexpr const char* program = CLEARWAY_BINARY_DIR "/tests/served_program";

/// Not of one that ended and that nobody has waited for yet.
bool runs(pid_t process) {
    std::ifstream file(fmt::format("/proc/{}/stat", process));
    std::string text;
    std::getline(file, text);
    const std::size_t name_end = text.rfind(") ");
    return name_end != std::string::npos && text[name_end + 2] != 'Z';
}

class ForkServerTest : public ::testing::Test {
  protected:
    ForkServerTest() { setenv("LOADS", loads().c_str(), 1); }
    ~ForkServerTest() override { unsetenv("LOADS"); }

    std::filesystem::path loads() const { return folder_.path() / "loads"; }
    std::filesystem::path output() const { return folder_.path() / "output"; }
    Command command(const std::string& word) const {
        return {.program = program, .arguments = {word}, .output = output()};
    }
    std::size_t starts() const {
        const std::string text = read_file(loads());
        return static_cast<std::size_t>(std::ranges::count(text, '\n'));
    }
    std::string said(const std::string& word) const { return fmt::format("{} of {}\n", word, getpid()); }

    support::TemporaryFolder folder_;
};

TEST_F(ForkServerTest, LoadsAProgramOnceAndItsChildrenAreOurs) {
    ForkServer server(program);
    for (const char* const word : {"a", "b b", "--c"}) {
        EXPECT_TRUE(wait(server.start(command(word))).ok());
        EXPECT_EQ(read_file(output()), said(word)) << "the file is truncated";
    }
    EXPECT_EQ(starts(), 1U);
}

TEST_F(ForkServerTest, TellsHowAChildEnded) {
    ForkServer server(program);
    EXPECT_EQ(wait(server.start(command("code 3"))).code, 3);
    EXPECT_EQ(wait(server.start(command(fmt::format("signal {}", SIGUSR1)))).signal, SIGUSR1);
    EXPECT_EQ(starts(), 1U) << "the server outlives its children";
}

TEST_F(ForkServerTest, ChildrenRunBesideEachOtherAndCanBeKilled) {
    ForkServer server(program);
    const Child sleeping = server.start(command("sleep"));
    Command other = command("other");
    other.output = folder_.path() / "other";
    EXPECT_TRUE(wait(server.start(other)).ok());
    EXPECT_FALSE(server.poll(sleeping).has_value());
    EXPECT_GT(server.resident_kib(sleeping).value_or(0), 0);
    server.kill(sleeping, SIGTERM);
    EXPECT_EQ(wait(sleeping).signal, SIGTERM);
}

TEST_F(ForkServerTest, WithoutAServerThatAnswersEachCommandIsAProgramOfItsOwn) {
    {
        ForkServer server(program);
        EXPECT_EQ(wait(server.start(command(fmt::format("signal {}", SIGKILL)))).signal, SIGKILL);
        ::kill(std::stoi(read_file(loads())), SIGKILL);
        for (const char* const word : {"a", "b"}) {
            EXPECT_TRUE(wait(server.start(command(word))).ok());
            EXPECT_EQ(read_file(output()), said(word));
        }
        EXPECT_EQ(starts(), 3U);
    }
    ForkServer no_server("/bin/echo");
    Command echo = command("word");
    echo.program = "/bin/echo";
    EXPECT_TRUE(wait(no_server.start(echo)).ok());
    EXPECT_EQ(read_file(output()), "word\n");
    ForkServer missing(folder_.path() / "missing");
    Command nothing = command("word");
    nothing.program = folder_.path() / "missing";
    EXPECT_EQ(wait(missing.start(nothing)).code, 127);
}

TEST_F(ForkServerTest, OtherCommandsAreNotItsOwn) {
    ForkServer server(program);
    Command with_environment = command("a");
    with_environment.environment = {{"NAME", "value"}};
    EXPECT_TRUE(wait(server.start(with_environment)).ok());
    EXPECT_TRUE(wait(server.start({.program = "true"})).ok());
    EXPECT_EQ(starts(), 1U) << "the program itself, and no server";
}

TEST_F(ForkServerTest, AnOutputThatCannotBeWrittenIsToldAndTheNextIsTaken) {
    ForkServer server(program);
    Command command = this->command("a");
    command.output = folder_.path() / "nosuch/output";
    EXPECT_THROW(server.start(command), EnvironmentError);
    EXPECT_TRUE(wait(server.start(this->command("a"))).ok());
    EXPECT_EQ(starts(), 1U);
}

TEST_F(ForkServerTest, LaterOrphansAreNotOurs) {
    ForkServer server(program);
    const Child child = server.start(command("orphan"));
    EXPECT_TRUE(wait(child).ok());
    const pid_t orphan = std::stoi(read_file(output()));
    std::ifstream file(fmt::format("/proc/{}/status", orphan));
    for (std::string line; std::getline(file, line);)
        EXPECT_NE(line, fmt::format("PPid:\t{}", getpid()));
    ::kill(orphan, SIGKILL);
}

TEST_F(ForkServerTest, NoChildOutlivesItsClient) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    const pid_t client = fork();
    if (client == 0) {
        ForkServer server(program);
        const pid_t child = server.start(command("sleep")).pid;
        _exit(write(ends[1], &child, sizeof child) == sizeof child ? 0 : 1);
    }
    pid_t child = 0;
    ASSERT_EQ(read(ends[0], &child, sizeof child), ssize_t{sizeof child});
    int status = 0;
    waitpid(client, &status, 0);
    EXPECT_EQ(status, 0);
    for (int look = 0; look < 200 && runs(child); ++look)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(runs(child));
}

}  // namespace
}  // namespace clearway::core
