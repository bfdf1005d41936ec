// Runs in the window of sumo-gui, on a screen in memory (Xvfb).
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

/// A screen in memory, with a number that nobody else has.
class Screen {
  public:
    explicit Screen(const std::filesystem::path& log)
        : child_(core::start({.program = "Xvfb",
                              .arguments = {"-displayfd", "1", "-screen", "0", "1280x900x24"},
                              .environment = {},
                              .output = log})) {
        for (int tries = 0; tries < 1000 && number_.empty(); ++tries) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            std::ifstream lines(log);  // with complaints about numbers that others have
            for (std::string line; std::getline(lines, line);)
                if (!line.empty() && line.find_first_not_of("0123456789") == std::string::npos)
                    number_ = line;
        }
    }
    ~Screen() {
        ::kill(child_.pid, SIGTERM);
        core::wait(child_);
    }
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    std::string name() const { return ":" + number_; }

  private:
    core::Child child_;
    std::string number_;
};

class ShownRunTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
        // sumo-gui keeps settings of its user; the tests are another one.
        setenv("HOME", folder().c_str(), 1);
    }

    static std::vector<std::string> shown(const std::vector<std::string>& more = {"--gui-delay", "0"}) {
        std::vector<std::string> words = {"run", "line", "--gui", "--no-solo", "--out", "out"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    static std::vector<std::string> slowly() { return shown({"--gui-delay", "500"}); }

    std::map<std::string, std::string> bytes_of(const std::string& run) const {
        return {{"run.json", read(run + "/run.json")}, {"vehicles.csv", read(run + "/vehicles.csv")}};
    }

    /// The sumo-gui of a run that is being shown, once it is connected.
    pid_t window_of(const core::Child& program) const {
        const auto first_child = [](pid_t process) {
            pid_t child = 0;
            std::ifstream(fmt::format("/proc/{0}/task/{0}/children", process)) >> child;
            return child;
        };
        const std::filesystem::path connected =
            folder() / fmt::format("out/work/window-{}/client/connection.log", program.pid);
        for (int tries = 0; tries < 1000; ++tries) {
            if (std::filesystem::exists(connected)) return first_child(first_child(program.pid));
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return 0;
    }

    void end_window_of(const core::Child& program, int signal) const {
        const pid_t window = window_of(program);
        ASSERT_GT(window, 0) << read("stderr.txt");
        ::kill(window, signal);
    }

    void write_script(const std::string& name, const std::string& text) const {
        std::filesystem::permissions(write(name, "#!/bin/sh\n" + text + "\n"),
                                     std::filesystem::perms::owner_all);
    }

    /// One that has ended and that nobody has collected is not.
    static bool is_alive(pid_t process) {
        std::string id, name, state;
        std::ifstream(fmt::format("/proc/{}/stat", process)) >> id >> name >> state;
        return !state.empty() && state != "Z";
    }
};

TEST_F(ShownRunTest, a_run_in_sumo_gui_equals_the_same_run_without_and_can_be_seen_again) {
    const Screen screen(folder() / "screen.log");
    const Environment here{.environment = {{"DISPLAY", screen.name()}}};
    write("view.xml",
          "<viewsettings><scheme name=\"clearway\"/><snapshot file=\"picture.png\" "
          "time=\"20\"/></viewsettings>");
    const Ended ended = clearway(shown({"--gui-delay", "0", "--gui-settings-file", "view.xml"}), here);
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("line/corridor/0 in sumo-gui"));
    EXPECT_TRUE(read("picture.png").starts_with("\x89PNG")) << "sumo-gui drew";
    EXPECT_FALSE(std::filesystem::exists(folder() / "out/work"));
    const Ended usual =
        clearway({"run", "line", "--condition", "corridor", "--no-solo", "--seeds", "1", "--out", "usual"});
    ASSERT_EQ(usual.code, 0) << usual.err;
    const std::string run = "/runs/line/corridor/00000";
    EXPECT_EQ(bytes_of("out" + run), bytes_of("usual" + run));
    EXPECT_EQ(ended.out, usual.out);
    EXPECT_EQ(clearway(shown(), here).code, 0) << "once more";
    write("out" + run + "/vehicles.csv", "changed\n");
    EXPECT_EQ(clearway(shown(), here).code, 7) << "another result for the same run";
}

TEST_F(ShownRunTest, a_window_that_fails_or_is_interrupted_leaves_no_run_folder) {
    const Screen screen(folder() / "screen.log");
    const Environment here{.environment = {{"DISPLAY", screen.name()}}};
    const core::Child failing = start(slowly(), here);
    end_window_of(failing, SIGKILL);
    const Ended failed = finish(failing);
    EXPECT_EQ(failed.code, 1);
    EXPECT_THAT(failed.err, AllOf(HasSubstr("killed by signal 9"), Not(HasSubstr("worker.log"))));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));

    const core::Child interrupted = start(slowly(), here);
    const pid_t window = window_of(interrupted);
    ASSERT_GT(window, 0) << read("stderr.txt");
    ::kill(interrupted.pid, SIGINT);
    EXPECT_EQ(finish(interrupted).code, 130);
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    for (int tries = 0; tries < 250 && is_alive(window); ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(is_alive(window));
}

TEST_F(ShownRunTest, a_closed_window_is_told_and_leaves_no_run_folder) {
    const Screen screen(folder() / "screen.log");
    // Closing the window makes sumo-gui end with code 0 in the middle of the run.
    write_script("bin/sumo-gui", "trap 'kill $!; exit 0' TERM; /usr/bin/sumo-gui \"$@\" & wait");
    const Environment here{
        .environment = {{"DISPLAY", screen.name()},
                        {"PATH", (folder() / "bin").string() + ":" + std::getenv("PATH")}}};
    const core::Child closed = start(slowly(), here);
    end_window_of(closed, SIGTERM);
    const Ended ended = finish(closed);
    EXPECT_EQ(ended.code, 5);
    EXPECT_THAT(ended.err, HasSubstr("the window was closed before the end of the run"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(ShownRunTest, what_cannot_be_shown_is_told) {
    const auto refused = [&](const std::vector<std::string>& more, const Environment& there, int code,
                             const std::string& said) {
        const Ended ended = clearway(shown(more), there);
        EXPECT_EQ(ended.code, code) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(said));
        EXPECT_THAT(ended.out, IsEmpty());
        EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    };
    refused({}, {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}}, 4, "DISPLAY is not set");
    refused({}, {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", "wayland-0"}}}, 4, "Xwayland");
    refused({}, {.environment = {{"DISPLAY", ":4711"}}}, 4, "unable to open display");
    std::filesystem::create_directory(folder() / "bin");
    std::filesystem::create_symlink("/usr/bin/netconvert", folder() / "bin/netconvert");
    refused({}, {.environment = {{"DISPLAY", ":4711"}, {"PATH", folder() / "bin"}}}, 4,
            "sumo-gui is not installed");
    refused({"--condition", "baseline", "--policy", "corridor"}, {}, 3, "baseline, corridor at once");
    refused({"--gui-settings-file", "none.xml"}, {}, 3, "none.xml is not a file");
    refused({"--gui-delay", "-1"}, {}, 2, "0 to 60000");
    const Ended alone = clearway({"run", "line", "--gui-delay", "5", "--out", "out"});
    EXPECT_EQ(alone.code, 2);
    EXPECT_THAT(alone.err, HasSubstr("--gui"));
}

}  // namespace
}  // namespace clearway::cli
