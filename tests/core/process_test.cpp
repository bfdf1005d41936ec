#include "core/process.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::core {
namespace {

using namespace std::chrono_literals;

Command shell(const std::string& script) {
    return {.program = "sh", .arguments = {"-c", script}};
}

class ProcessTest : public ::testing::Test {
  protected:
    std::string output_of(Command command) {
        command.output = folder_.path() / "output";
        EXPECT_TRUE(run(command).ok());
        return read_file(command.output);
    }

    support::TemporaryFolder folder_;
};

TEST_F(ProcessTest, ReportsExitCodes) {
    EXPECT_TRUE(run(shell("exit 0")).ok());
    const Exit exit = run(shell("exit 3"));
    EXPECT_EQ(exit.code, 3);
    EXPECT_EQ(exit.signal, 0);
    EXPECT_FALSE(exit.ok());
    EXPECT_EQ(exit.describe(), "exit code 3");
}

TEST_F(ProcessTest, ReportsSignals) {
    const Exit exit = run(shell("kill -SEGV $$"));
    EXPECT_EQ(exit.signal, SIGSEGV);
    EXPECT_FALSE(exit.ok());
    EXPECT_EQ(exit.describe(), "killed by signal 11 (Segmentation fault)");
}

TEST_F(ProcessTest, AProgramThatIsNotThereExitsWith127) {
    EXPECT_EQ(run({.program = "clearway-no-such-program"}).code, 127);
    EXPECT_EQ(run({.program = folder_.path() / "missing"}).code, 127);
}

TEST_F(ProcessTest, BothStreamsGoToTheFileWhichIsTruncated) {
    folder_.write("output", std::string(1000, 'x'));
    EXPECT_EQ(output_of(shell("echo out; echo err >&2")), "out\nerr\n");
}

TEST_F(ProcessTest, WorksInItsFolderOrNotAtAll) {
    Command command = shell("pwd -P");
    command.folder = std::filesystem::canonical(folder_.path());
    EXPECT_EQ(output_of(command), command.folder.string() + "\n");
    command.folder /= "nosuch";
    EXPECT_EQ(run(command).code, 127);
}

TEST_F(ProcessTest, ArgumentsReachTheProgramUnchanged) {
    EXPECT_EQ(output_of({.program = "printf", .arguments = {"%s|", "a b", "$HOME", "*", "", "\"q\""}}),
              "a b|$HOME|*||\"q\"|");
}

TEST_F(ProcessTest, EnvironmentIsAddedToAndReplaced) {
    ASSERT_EQ(setenv("CLEARWAY_TEST_KEPT", "kept", 1), 0);
    ASSERT_EQ(setenv("CLEARWAY_TEST_REPLACED", "old", 1), 0);
    Command command = shell("echo $CLEARWAY_TEST_KEPT $CLEARWAY_TEST_REPLACED $CLEARWAY_TEST_NEW");
    command.environment = {{"CLEARWAY_TEST_REPLACED", "replaced"}, {"CLEARWAY_TEST_NEW", "a=b"}};
    EXPECT_EQ(output_of(command), "kept replaced a=b\n");
    EXPECT_STREQ(getenv("CLEARWAY_TEST_REPLACED"), "old");
}

TEST_F(ProcessTest, AnOutputThatCannotBeMadeIsRefusedBeforeTheStart) {
    Command command = shell("exit 0");
    command.output = folder_.path() / "missing" / "output";
    EXPECT_THROW(start(command), EnvironmentError);
}

TEST_F(ProcessTest, PollAnswersOnceTheChildHasEnded) {
    // The child ends when its input does, so nothing here depends on how fast the machine is.
    const auto fifo = folder_.path() / "fifo";
    ASSERT_EQ(run({.program = "mkfifo", .arguments = {fifo.string()}}).code, 0);
    const Child child = start(shell("read line < " + fifo.string() + "; exit 5"));
    EXPECT_FALSE(poll(child).has_value());
    std::ofstream(fifo) << "go\n";
    std::optional<Exit> exit;
    for (int wait_ms = 0; !exit && wait_ms < 20'000; wait_ms += 5) {
        std::this_thread::sleep_for(5ms);
        exit = poll(child);
    }
    ASSERT_TRUE(exit.has_value());
    EXPECT_EQ(exit->code, 5);
    EXPECT_THROW(poll(child), EnvironmentError);
}

TEST_F(ProcessTest, MeasuresTimeAndMemory) {
    const Exit sleeping = run({.program = "sleep", .arguments = {"0.2"}});
    EXPECT_GE(sleeping.wall_s, 0.19);
    EXPECT_LT(sleeping.cpu_s, 0.15);
    EXPECT_GT(sleeping.peak_kib, 100);
    EXPECT_GT(run(shell("i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done")).cpu_s, 0.005);
}

/// State letter of a process, `X` when it is gone.
char state_of(pid_t pid) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string number, name;
    char state = 'X';
    stat >> number >> name >> state;
    return state;
}

// A limit of memory counts what a child needs, never what the process that started it holds.
TEST_F(ProcessTest, AStartedChildHoldsNoMemoryOfItsParent) {
    const std::vector<char> held(std::size_t{256} << 20, 'x');
    for (int attempt = 0; attempt < 20; ++attempt) {
        const Child child = start(shell("exec sleep 60"));
        const auto resident = resident_kib(child.pid);
        ::kill(child.pid, SIGKILL);
        wait(child);
        ASSERT_TRUE(resident);
        ASSERT_LT(*resident, 64 * 1024) << held.back();
    }
}

TEST_F(ProcessTest, ChildrenEndWithTheirParent) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t parent = fork();
    if (parent == 0) {
        const pid_t child = start({.program = "sleep", .arguments = {"60"}}).pid;
        const bool told = write(ends[1], &child, sizeof child) == sizeof child;
        if (told) pause();
        _exit(1);
    }
    pid_t grandchild = 0;
    ASSERT_EQ(read(ends[0], &grandchild, sizeof grandchild), static_cast<ssize_t>(sizeof grandchild));
    EXPECT_NE(state_of(grandchild), 'X');
    kill(parent, SIGKILL);
    waitpid(parent, nullptr, 0);
    char state = '?';
    for (int wait_ms = 0; state != 'X' && state != 'Z' && wait_ms < 20'000; wait_ms += 5) {
        std::this_thread::sleep_for(5ms);
        state = state_of(grandchild);
    }
    EXPECT_TRUE(state == 'X' || state == 'Z') << state;
    close(ends[0]);
    close(ends[1]);
}

/// How a process ends in which these streams are closed first; it ends with 0 if `holds`.
template <class Holds>
int end_with_closed(const std::vector<int>& streams, const Holds& holds) {
    const pid_t child = fork();
    if (child == 0) {
        for (const int stream : streams)
            close(stream);
        _exit(holds() ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return status;
}

TEST_F(ProcessTest, ClosedStandardStreamsAreOpenedAndAreNoFiles) {
    for (const std::vector<int>& streams : {std::vector{0, 1, 2}, std::vector{2}, std::vector{0, 2}}) {
        EXPECT_EQ(end_with_closed(streams,
                                  [] {
                                      open_standard_streams();
                                      return open("/dev/null", O_RDONLY) > STDERR_FILENO &&
                                             write(STDERR_FILENO, "x", 1) == 1;
                                  }),
                  0);
    }
    EXPECT_EQ(end_with_closed({1},
                              [] {
                                  open_standard_streams();
                                  return write(STDOUT_FILENO, "x", 1) < 0;
                              }),
              0)
        << "output that is lost must be told";
}

TEST_F(ProcessTest, AFileWithTheNumberOfAClosedStreamStillTakesTheOutputOfAChild) {
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
        Command command = shell("echo out; echo err >&2");
        command.output = folder_.path() / "output";
        std::filesystem::remove(command.output);
        EXPECT_EQ(end_with_closed({stream}, [&] { return run(command).ok(); }), 0);
        EXPECT_EQ(read_file(command.output), "out\nerr\n");
    }
}

TEST_F(ProcessTest, TailGivesTheLastLines) {
    const auto file = folder_.write("log", "one\ntwo\nthree\nfour");
    EXPECT_EQ(tail(file, 2), "three\nfour\n");
    EXPECT_EQ(tail(file, 99), "one\ntwo\nthree\nfour\n");
    EXPECT_EQ(tail(file, 0), "");
    EXPECT_EQ(tail(folder_.path() / "missing", 5), "");
}

TEST_F(ProcessTest, KnowsItsOwnFolder) {
    EXPECT_TRUE(std::filesystem::exists(program_folder() / "core_test"));
}

TEST(WithOption, ReplacesWhatACommandSaysOrAddsIt) {
    using Words = std::vector<std::string>;
    const Words bare = {"run", "town"};
    EXPECT_EQ(with_option(bare, "--density", "0.8"), (Words{"run", "town", "--density", "0.8"}));
    EXPECT_EQ(with_option({"run", "--density", "2", "town"}, "--density", "0.8"),
              (Words{"run", "--density", "0.8", "town"}));
    EXPECT_EQ(with_option({"run", "--density=2", "town"}, "--density", "0.8"),
              (Words{"run", "--density=0.8", "town"}));
    EXPECT_EQ(with_option({"run", "--densityx=2"}, "--density", "1").size(), 4U) << "another option";
}

}  // namespace
}  // namespace clearway::core
