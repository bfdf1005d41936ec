#include "server/live_server.hpp"

#include <chrono>
#include <ctime>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "core/error.hpp"
#include "server/browser.hpp"
#include "server/live_show.hpp"
#include "support/message_of.hpp"

namespace clearway::server {
namespace {

using testing::AllOf;
using testing::HasSubstr;

LiveConfig config_of(std::size_t runs, double speed = 0.0, bool allow_control = false) {
    LiveConfig config;
    config.runs = runs;
    config.speed = speed;
    config.allow_control = allow_control;
    return config;
}

/// A frame as a viewer hears it: run, kind, length, time in ms, rest.
struct HeardFrame {
    std::size_t run = 0;
    bool is_key = false;
    std::uint64_t time_ms = 0;
};

std::uint64_t number_at(const std::string& bytes, std::size_t& at) {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
        const auto byte = static_cast<unsigned char>(bytes.at(at++));
        value |= static_cast<std::uint64_t>(byte & 0x7fU) << shift;
        if (byte < 0x80U) return value;
    }
}

/// The next frame, past all words.
std::optional<HeardFrame> next_frame(Viewer& viewer) {
    while (const std::optional<Viewer::Heard> heard = viewer.next()) {
        if (heard->is_text) continue;
        std::size_t at = 2;
        const std::uint64_t length = number_at(heard->bytes, at);
        EXPECT_EQ(length, heard->bytes.size() - at) << "one whole block";
        return HeardFrame{static_cast<std::size_t>(heard->bytes[0]), heard->bytes[1] == 2,
                          number_at(heard->bytes, at)};
    }
    return std::nullopt;
}

TEST(LiveServer, a_viewer_is_told_who_runs_and_sees_the_frames_of_each_run) {
    LiveShow show(config_of(2));
    // The order in which runs connect does not matter.
    const FakeRun right = show.run(1, "corridor");
    const FakeRun left = show.run(0, "baseline");
    left.key(10.0);
    right.key(10.0);
    Viewer viewer(show.port());
    const core::Json welcome = viewer.words("welcome");
    EXPECT_EQ(welcome.at("runs").at(0).at("condition"), "baseline");
    EXPECT_EQ(welcome.at("runs").at(1).at("condition"), "corridor");
    EXPECT_FALSE(welcome.at("allow_control").get<bool>());
    EXPECT_EQ(next_frame(viewer)->run, 0U);
    EXPECT_EQ(next_frame(viewer)->run, 1U);
    left.delta(10.5);
    EXPECT_EQ(next_frame(viewer)->time_ms, 10'500U);
}

TEST(LiveServer, a_viewer_that_came_before_the_runs_waits_for_them) {
    LiveShow show(config_of(1));
    Viewer viewer(show.port());
    const FakeRun run = show.run(0, "baseline");
    EXPECT_EQ(viewer.words("welcome").at("runs").at(0).at("condition"), "baseline");
    run.key(3.0);
    EXPECT_EQ(next_frame(viewer)->time_ms, 3'000U);
}

TEST(LiveServer, runs_may_go_in_step) {
    LiveShow show(config_of(2));
    const FakeRun left = show.run(0, "baseline");
    const FakeRun right = show.run(1, "corridor");
    left.key(10.0);
    EXPECT_FALSE(left.is_told_within(200)) << "the other has not begun";
    right.key(10.0);
    EXPECT_DOUBLE_EQ(left.allowed(), 11.0);
    EXPECT_DOUBLE_EQ(right.allowed(), 11.0);
    left.delta(11.0);
    EXPECT_FALSE(left.is_told_within(200)) << "the other is behind";
    right.delta(10.5);
    EXPECT_DOUBLE_EQ(left.allowed(), 11.5);
}

TEST(LiveServer, a_viewer_that_reads_nothing_slows_nobody_and_loses_frames_that_are_counted) {
    constexpr std::size_t frame_bytes = 100'000;
    constexpr int frames = 600;
    constexpr int key_period = 20;
    LiveShow show(config_of(1));
    const FakeRun run = show.run(0, "baseline");
    Viewer quick(show.port());
    Viewer stopped(show.port());
    quick.words("welcome");
    stopped.words("welcome");
    for (int i = 0; i < frames; ++i) {
        const double time_s = 0.25 * i;
        i % key_period == 0 ? run.key(time_s, frame_bytes) : run.delta(time_s, frame_bytes);
        const auto frame = next_frame(quick);
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->time_ms, static_cast<std::uint64_t>(250 * i)) << "none is left out";
    }
    EXPECT_EQ(quick.words("status").at("dropped"), 0);
    // It reads again: after a gap there is always a key frame.
    std::uint64_t seen = 0;
    std::uint64_t gaps = 0;
    std::uint64_t expected_ms = 0;
    run.key(1000.0);
    for (;;) {
        const auto frame = next_frame(stopped);
        ASSERT_TRUE(frame);
        if (frame->time_ms == 1'000'000U) {
            EXPECT_TRUE(frame->is_key);
            break;
        }
        if (frame->time_ms != expected_ms) {
            ++gaps;
            EXPECT_TRUE(frame->is_key);
        }
        ++seen;
        expected_ms = frame->time_ms + 250;
    }
    EXPECT_EQ(stopped.words("status").at("dropped"), frames - seen);
    EXPECT_LT(seen * frame_bytes, 25'000'000U) << "the queue is bounded";
    EXPECT_GT(seen, 20U);
    EXPECT_LE(gaps, 1U);
    const LiveCounts counts = show.counts();
    EXPECT_EQ(counts.frames_dropped, frames - seen);
    EXPECT_EQ(counts.clients, 2U);
}

TEST(LiveServer, who_may_not_control_is_shown_the_door_and_changes_nothing) {
    LiveShow show(config_of(1, 1.0));
    const FakeRun run = show.run(0, "baseline");
    Viewer viewer(show.port());
    viewer.words("welcome");
    viewer.say(R"({"do": "pause"})");
    while (viewer.next()) {
    }
    EXPECT_EQ(viewer.close_code(), 1008U);
    EXPECT_THAT(viewer.close_reason(), HasSubstr("--allow-control"));
    Viewer other(show.port());
    EXPECT_FALSE(other.words("status").at("paused").get<bool>());
    EXPECT_EQ(show.counts().refused, 1U);
}

TEST(LiveServer, rubbish_ends_the_connection_it_came_by_and_no_other) {
    LiveShow show(config_of(1, 1.0, true));
    const FakeRun run = show.run(0, "baseline");
    Viewer good(show.port());
    good.words("welcome");
    const std::vector<std::string> rubbish = {"",
                                              "not JSON",
                                              "[]",
                                              "null",
                                              "{}",
                                              R"({"do": 5})",
                                              R"({"do": "fly"})",
                                              R"({"do": "speed"})",
                                              R"({"do": "speed", "times": -1})",
                                              R"({"do": "speed", "times": 1e9})",
                                              R"({"do": "speed", "times": 1e999})",
                                              R"({"do": "speed", "times": "5"})",
                                              std::string(900, '[')};
    for (const std::string& words : rubbish) {
        Viewer viewer(show.port());
        viewer.words("welcome");
        viewer.say(words);
        while (viewer.next()) {
        }
        EXPECT_EQ(viewer.close_code(), 1007U) << words;
    }
    Viewer binary(show.port());
    binary.words("welcome");
    binary.say_bytes(std::string("\x00\xff\x01\x80\xfe", 5));
    while (binary.next()) {
    }
    EXPECT_EQ(binary.close_code(), 1007U);
    Viewer large(show.port());
    large.words("welcome");
    large.say(std::string(1'200, ' '));  // sent at once: what comes after a closed connection would be lost
    while (large.next()) {
    }
    EXPECT_EQ(large.close_code(), 1009U);
    run.key(7.0);
    EXPECT_EQ(next_frame(good)->time_ms, 7'000U);
    EXPECT_DOUBLE_EQ(good.words("status").at("speed").get<double>(), 1.0);
}

TEST(LiveServer, who_may_control_pauses_steps_and_sets_the_speed) {
    LiveShow show(config_of(1, 1.0, true));
    const FakeRun run = show.run(0, "baseline");
    run.key(10.0);
    Viewer viewer(show.port());
    EXPECT_TRUE(viewer.words("welcome").at("allow_control").get<bool>());
    const auto status_after = [&](const std::string& words) {
        viewer.say(words);
        return viewer.words("status");
    };
    viewer.words("status");
    EXPECT_TRUE(status_after(R"({"do": "pause"})").at("paused").get<bool>());
    double allowed_s = 0.0;
    while (run.is_told_within(300))
        allowed_s = run.allowed();
    EXPECT_FALSE(run.is_told_within(300)) << "paused";
    run.delta(allowed_s + 0.1);
    viewer.say(R"({"do": "step"})");
    EXPECT_NEAR(run.allowed(), allowed_s + 0.1, 0.01);
    EXPECT_FALSE(run.is_told_within(300)) << "one step";
    viewer.say(R"({"do": "speed", "times": 20})");
    viewer.say(R"({"do": "go"})");
    core::Json status;
    do
        status = viewer.words("status");
    while (status.at("paused").get<bool>());
    EXPECT_DOUBLE_EQ(status.at("speed").get<double>(), 20.0);
    EXPECT_TRUE(run.is_told_within(2000));
}

TEST(LiveServer, one_viewer_too_many_is_told_so) {
    constexpr int most = 8;
    LiveShow show(config_of(1));
    const FakeRun run = show.run(0, "baseline");
    std::vector<std::unique_ptr<Viewer>> viewers;
    for (int i = 0; i < most; ++i)
        viewers.push_back(std::make_unique<Viewer>(show.port()));
    const std::string ask = fmt::format(
        "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nOrigin: http://127.0.0.1:{}\r\n",
        show.port());
    const Answer refused = get(show.port(), "/stream", ask);
    EXPECT_EQ(refused.status, 503U);
    EXPECT_THAT(refused.body, HasSubstr("too many"));
    viewers.pop_back();
    for (int tries = 0; tries < 100 && get(show.port(), "/stream", ask).status != 101U; ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(show.counts().clients, 9U) << "a place that is free again is given";
}

TEST(LiveServer, a_crowd_of_connections_does_not_end_the_service) {
    LiveShow show(config_of(1));
    {
        boost::asio::io_context loop;
        std::vector<boost::asio::ip::tcp::socket> idle;
        for (int i = 0; i < 200; ++i)
            idle.emplace_back(loop).connect({boost::asio::ip::make_address("127.0.0.1"), show.port()});
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
    unsigned status = 0;
    for (int tries = 0; tries < 100 && status != 200U; ++tries) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        try {
            status = get(show.port(), "/").status;
        } catch (const boost::system::system_error&) {
            status = 0;
        }
    }
    EXPECT_EQ(status, 200U);
    EXPECT_GE(show.counts().refused, 100U);
}

/// While it lives, this process can open nothing more.
class NoDescriptors {
  public:
    NoDescriptors() {
        ::getrlimit(RLIMIT_NOFILE, &before_);
        const rlimit none{0, before_.rlim_max};
        ::setrlimit(RLIMIT_NOFILE, &none);
    }
    ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
    NoDescriptors(const NoDescriptors&) = delete;
    NoDescriptors& operator=(const NoDescriptors&) = delete;

  private:
    rlimit before_{};
};

TEST(LiveServer, that_gets_no_descriptor_blames_the_machine) {
    const LiveConfig config = config_of(1);
    std::string said;
    {
        const NoDescriptors limit;
        try {
            const LiveServer server(config, "/tmp");
        } catch (const core::EnvironmentError& error) {
            said = error.what();
        }
    }
    EXPECT_EQ(
        said,
        "the live page cannot be served: Too many open files. The machine failed: give the same command "
        "again");
}

TEST(LiveServer, a_connection_without_a_descriptor_waits_and_takes_no_time_of_the_processor) {
    LiveShow show(config_of(1));
    boost::asio::io_context loop;
    boost::asio::ip::tcp::socket browser(loop);
    browser.open(boost::asio::ip::tcp::v4());
    {
        const NoDescriptors limit;
        browser.connect({boost::asio::ip::make_address("127.0.0.1"), show.port()});
        const std::clock_t before = std::clock();
        std::this_thread::sleep_for(std::chrono::seconds(1));
        const double used_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
        EXPECT_LT(used_s, 0.2);
    }
    boost::asio::write(browser, boost::asio::buffer(fmt::format(
                                    "GET / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", show.port())));
    std::string answer(12, ' ');
    boost::asio::read(browser, boost::asio::buffer(answer));
    EXPECT_EQ(answer, "HTTP/1.1 200");
}

TEST(LiveServer, when_the_runs_are_over_viewers_are_told_and_the_server_ends) {
    LiveShow show(config_of(2));
    FakeRun left = show.run(0, "baseline");
    FakeRun right = show.run(1, "corridor");
    left.key(1.0);
    right.key(1.0);
    Viewer viewer(show.port());
    viewer.words("welcome");
    left.close();
    EXPECT_FALSE(viewer.words("status").at("ended").get<bool>());
    right.close();
    while (!viewer.words("status").at("ended").get<bool>()) {
    }
    EXPECT_FALSE(viewer.next());
    EXPECT_EQ(viewer.close_code(), 1000U);
    EXPECT_TRUE(show.ends());
}

TEST(LiveServer, a_viewer_that_reads_nothing_does_not_keep_the_server_for_long) {
    LiveShow show(config_of(1));
    FakeRun run = show.run(0, "baseline");
    Viewer stopped(show.port());
    stopped.words("welcome");
    run.key(0.0);
    for (int i = 1; i < 200; ++i)
        run.delta(0.25 * i, 100'000);
    run.close();
    EXPECT_TRUE(show.ends());
}

TEST(LiveServer, a_port_that_is_taken_is_told) {
    LiveShow show;
    support::TemporaryFolder folder;
    LiveConfig config;
    config.port = show.port();
    EXPECT_THAT(support::message_of<core::EnvironmentError>([&] { LiveServer(config, folder.path()); }),
                AllOf(HasSubstr(fmt::format("127.0.0.1 port {}", show.port())), HasSubstr("in use"),
                      HasSubstr("--port")));
}

TEST(LiveServer, an_address_of_another_machine_is_told) {
    support::TemporaryFolder folder;
    LiveConfig config;
    config.host = "192.0.2.7";
    config.token = "secret-of-sixteen";
    EXPECT_THAT(support::message_of<core::EnvironmentError>([&] { LiveServer(config, folder.path()); }),
                AllOf(HasSubstr("192.0.2.7"), HasSubstr("Cannot assign"),
                      HasSubstr("--host takes an address or a name of this machine")));
}

}  // namespace
}  // namespace clearway::server
