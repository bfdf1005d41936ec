// Runs that are watched while they happen, from the command line to the files.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "server/browser.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

using server::get;
using server::Viewer;
using Words = std::vector<std::string>;

constexpr std::chrono::milliseconds pause{20};
constexpr int most_tries = 3000;

Words joined(Words first, const Words& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

/// What is run, by whichever verb.
const Words mine = {"line",           "--policy", "dissertation", "--failure", "B10", "--predictor",
                    "dead_reckoning", "--name",   "mine",         "--seed",    "7"};

Words live(const Words& more) {
    return joined(joined({"live"}, mine), joined({"--out", "out", "--port", "0"}, more));
}
/// So slow that the runs are not over while a test looks at them.
Words slowly(const Words& more = {}) {
    return live(joined({"--speed", "0.01"}, more));
}

/// One that has ended and that nobody has collected is not.
bool is_alive(pid_t process) {
    std::string id, name, state;
    std::ifstream(fmt::format("/proc/{}/stat", process)) >> id >> name >> state;
    return !state.empty() && state != "Z";
}

std::vector<pid_t> children_of(pid_t process) {
    std::vector<pid_t> all;
    std::ifstream list(fmt::format("/proc/{0}/task/{0}/children", process));
    for (pid_t child = 0; list >> child;)
        all.push_back(child);
    return all;
}

class LiveTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
    }

    /// The address that a program prints once it serves.
    std::string address_of(const core::Child& program) const {
        for (int tries = 0; tries < most_tries && is_alive(program.pid); ++tries) {
            if (std::filesystem::exists(folder() / "stdout.txt")) {
                const std::string out = read("stdout.txt");
                if (out.find('\n') != std::string::npos) return out.substr(0, out.find('\n'));
            }
            std::this_thread::sleep_for(pause);
        }
        throw std::runtime_error("it does not serve: " + read("stderr.txt"));
    }
    static std::uint16_t port_of(const std::string& address) {
        return static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
    }

    /// Everything that a run folder says of its runs, but for the command and how long it took.
    std::map<std::string, std::string> bytes_of(const std::string& out) const {
        std::map<std::string, std::string> all;
        for (const char* const file :
             {"manifest.json", "runs.csv", "vehicles.csv", "runs/line/baseline/00000/run.json",
              "runs/line/baseline/00000/vehicles.csv", "runs/line/mine/00000/run.json",
              "runs/line/mine/00000/vehicles.csv"})
            all[file] = read(out + "/" + file);
        return all;
    }
    void expect_as_run(const Ended& live) const {
        const Ended usual = clearway(
            joined(joined({"run"}, mine), {"--seeds", "1", "--no-solo", "--no-perfect", "--out", "usual"}));
        ASSERT_EQ(usual.code, 0) << usual.err;
        EXPECT_EQ(bytes_of("out"), bytes_of("usual"));
        ASSERT_THAT(live.out, testing::StartsWith("http://127.0.0.1:"));
        EXPECT_EQ(live.out.substr(live.out.find('\n') + 1), usual.out);
        EXPECT_FALSE(std::filesystem::exists(folder() / "out/work"));
    }
    /// Sends a signal to a program that serves two runs, and looks at what is left.
    void end_by(int signal, int expected_code) const;
};

TEST_F(LiveTest, nobody_watches_and_all_is_as_run_writes_and_prints_it) {
    const Ended ended = clearway(live({"--speed", "0"}));
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("0 viewers, 0 refused"));
    expect_as_run(ended);
}

TEST_F(LiveTest, a_viewer_who_pauses_steps_and_sets_the_speed_changes_no_byte) {
    const core::Child program = start(slowly({"--allow-control"}));
    Viewer viewer(port_of(address_of(program)));
    const core::Json welcome = viewer.words("welcome");
    EXPECT_EQ(welcome.at("runs").size(), 2U);
    EXPECT_EQ(welcome.at("runs").at(0).at("condition"), "baseline");
    EXPECT_EQ(welcome.at("runs").at(1).at("condition"), "mine");
    for (const char* const words : {R"({"do": "pause"})", R"({"do": "step"})", R"({"do": "step"})",
                                    R"({"do": "speed", "times": 0})", R"({"do": "go"})"}) {
        viewer.say(words);
        viewer.words("status");
    }
    std::array<std::size_t, 2> frames{};
    while (const std::optional<Viewer::Heard> heard = viewer.next()) {
        if (!heard->is_text) ++frames.at(static_cast<unsigned char>(heard->bytes.at(0)));
    }
    const Ended ended = finish(program);
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_GT(frames[0], 50U);
    EXPECT_GT(frames[1], 50U);
    EXPECT_THAT(ended.err, HasSubstr("1 viewer, 0 refused"));
    expect_as_run(ended);
}

TEST_F(LiveTest, the_same_words_show_the_runs_again_and_another_result_is_told) {
    ASSERT_EQ(clearway(live({"--speed", "0"})).code, 0);
    const std::map<std::string, std::string> before = bytes_of("out");
    const Ended again = clearway(live({"--speed", "0"}));
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(bytes_of("out"), before);
    write("out/runs/line/mine/00000/vehicles.csv", "changed\n");
    EXPECT_EQ(clearway(live({"--speed", "0"})).code, 7) << "another result for the same run";
    EXPECT_FALSE(std::filesystem::exists(folder() / "out/work"));
}

TEST_F(LiveTest, one_condition_can_be_watched_alone_or_beside_another_than_the_baseline) {
    const auto watched = [&](const Words& more) {
        const core::Child program = start(slowly(more));
        Viewer viewer(port_of(address_of(program)));
        const core::Json welcome = viewer.words("welcome");
        ::kill(program.pid, SIGTERM);
        EXPECT_EQ(finish(program).code, 143);
        std::filesystem::remove_all(folder() / "out");
        std::filesystem::remove(folder() / "stdout.txt");
        Words conditions;
        for (const core::Json& run : welcome.at("runs"))
            conditions.push_back(run.at("condition"));
        return conditions;
    };
    EXPECT_EQ(watched({"--against", "none"}), Words{"mine"});
    EXPECT_EQ(watched({"--against", "graph_simulation"}), (Words{"graph_simulation", "mine"}));
}

TEST_F(LiveTest, beyond_this_machine_a_token_is_printed_and_needed) {
    const core::Child program = start(slowly({"--host", "0.0.0.0"}));
    const std::string address = address_of(program);
    EXPECT_THAT(address, Not(HasSubstr("0.0.0.0"))) << "what is printed can be opened";
    const std::uint16_t port = port_of(address);
    const std::size_t query = address.find("/?token=");
    ASSERT_NE(query, std::string::npos) << address;
    EXPECT_EQ(address.size(), query + 8 + 32) << "128 random bits";
    EXPECT_EQ(get(port, "/").status, 401U);
    EXPECT_EQ(get(port, "/?token=").status, 401U);
    EXPECT_EQ(get(port, "/?token=00000000000000000000000000000000").status, 401U);
    EXPECT_EQ(get(port, address.substr(query)).status, 200U);
    Viewer viewer(port, "/stream" + address.substr(query + 1));
    EXPECT_FALSE(viewer.words("welcome").at("allow_control").get<bool>());
    ::kill(program.pid, SIGINT);
    EXPECT_THAT(finish(program).err, HasSubstr("1 viewer, 3 refused"));
}

void LiveTest::end_by(int signal, int expected_code) const {
    const core::Child program = start(slowly());
    Viewer viewer(port_of(address_of(program)));
    viewer.words("welcome");
    const std::vector<pid_t> workers = children_of(program.pid);
    EXPECT_EQ(workers.size(), 2U);
    EXPECT_TRUE(std::ranges::all_of(workers, is_alive));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder() / "out/work"), {}), 1);
    ::kill(program.pid, signal);
    const Ended ended = finish(program);
    EXPECT_EQ(ended.code, expected_code) << ended.err;
    EXPECT_TRUE(std::ranges::none_of(workers, is_alive)) << "no worker outlives the program";
    EXPECT_FALSE(std::filesystem::exists(folder() / "out/work"));
}

TEST_F(LiveTest, an_interruption_leaves_no_process_and_no_work_and_the_folder_goes_on) {
    end_by(SIGINT, 130);
    const Ended ended = clearway(live({"--speed", "0"}));
    ASSERT_EQ(ended.code, 0) << ended.err;
    expect_as_run(ended);
}

TEST_F(LiveTest, a_termination_leaves_no_process_and_no_work) {
    end_by(SIGTERM, 143);
}

TEST_F(LiveTest, what_a_killed_one_leaves_goes_with_the_next) {
    const std::filesystem::path temporary = folder() / "temporary";
    std::filesystem::create_directory(temporary);
    const auto things_in = [](const std::filesystem::path& place) {
        return std::filesystem::exists(place) ? std::distance(std::filesystem::directory_iterator(place), {})
                                              : 0;
    };
    const core::Child program = start(slowly(), {.environment = {{"TMPDIR", temporary.string()}}});
    {
        Viewer viewer(port_of(address_of(program)));
        viewer.words("welcome");
    }
    const std::vector<pid_t> workers = children_of(program.pid);
    ::kill(program.pid, SIGKILL);
    finish(program);
    for (int tries = 0; tries < most_tries && std::ranges::any_of(workers, is_alive); ++tries)
        std::this_thread::sleep_for(pause);
    EXPECT_TRUE(std::ranges::none_of(workers, is_alive)) << "no worker outlives the program";
    EXPECT_EQ(things_in(folder() / "out/work"), 1) << "it could not remove it";
    EXPECT_EQ(things_in(temporary), 1);
    const Ended ended = clearway(live({"--speed", "0"}), {.environment = {{"TMPDIR", temporary.string()}}});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder() / "out/work"));
    EXPECT_EQ(things_in(temporary), 0);
    expect_as_run(ended);
}

TEST_F(LiveTest, a_run_that_dies_ends_the_other_and_is_told) {
    const core::Child program = start(slowly());
    Viewer viewer(port_of(address_of(program)));
    viewer.words("welcome");
    const std::vector<pid_t> workers = children_of(program.pid);
    ASSERT_EQ(workers.size(), 2U);
    ::kill(workers.back(), SIGKILL);
    const Ended ended = finish(program);
    EXPECT_EQ(ended.code, 1);
    EXPECT_THAT(ended.err, HasSubstr("mine: killed by signal 9"));
    EXPECT_FALSE(is_alive(workers.front()));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out/work"));
}

TEST_F(LiveTest, a_port_that_is_taken_is_told_and_leaves_no_run_folder) {
    const core::Child program = start(slowly());
    const std::string port = std::to_string(port_of(address_of(program)));
    const Ended ended = clearway({"live", "line", "--port", port, "--out", "other"}, {.output = "other.txt"});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("127.0.0.1 port " + port), HasSubstr("in use"),
                                 HasSubstr("--port, or 0 for any that is free")));
    EXPECT_THAT(read("other.txt"), IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(folder() / "other"));
    ::kill(program.pid, SIGINT);
    finish(program);
}

TEST_F(LiveTest, what_cannot_be_served_or_watched_is_told_and_leaves_no_run_folder) {
    const auto refused = [&](const Words& more, int code, const std::string& said) {
        const Ended ended = clearway(joined({"live", "line", "--out", "out"}, more));
        EXPECT_EQ(ended.code, code) << said;
        EXPECT_THAT(ended.err, HasSubstr(said));
        EXPECT_THAT(ended.out, IsEmpty());
        EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    };
    refused({"--host", "my..machine"}, 3, "--host: `my..machine` is neither an address nor a known name");
    refused({"--host", "192.0.2.7"}, 4, "cannot serve at 192.0.2.7 port 8150: Cannot assign");
    refused({"--host", "0.0.0.0", "--token", "a b"}, 3,
            "--token: the token has characters that are not allowed in an address");
    refused({"--host", "0.0.0.0", "--token", "a"}, 3, "a token of 1 characters can be guessed");
    refused({"--port", "65536"}, 2, "--port: 65536 is out of range (allowed: 0 to 65535)");
    refused({"--port", "-1"}, 2, "(allowed: 0 to 65535)");
    refused({"--port", "http"}, 2, "(allowed: 0 to 65535)");
    refused({"--speed", "-1"}, 2, "--speed");
    refused({"--speed", "1001"}, 2, "0 to 1000");
    refused({"--against", "baselin"}, 3, "Did you mean 'baseline'?");
    refused({"--against", "solo"}, 3, "solo has no traffic to watch");
    refused({"--condition", "solo"}, 3, "solo has no traffic to watch");
    refused({"--condition", "corridr"}, 3, "Did you mean 'corridor'?");
    refused({"--condition", "baseline", "--policy", "corridor"}, 3, "baseline, corridor at once");
    const Ended nothing = clearway({"live"});
    EXPECT_EQ(nothing.code, 2);
    EXPECT_EQ(clearway({"live", "lin"}).code, 3);
}

}  // namespace
}  // namespace clearway::cli
