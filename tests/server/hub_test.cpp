#include "server/detail/hub.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/json.hpp"
#include "view/frame_encoder.hpp"

namespace clearway::server::detail {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using view::BlockKind;

/// The content of a frame that only says its time, ms; below 128 a number is one byte.
std::string frame_at(char time_ms, const std::string& rest = "") {
    return std::string(1, time_ms) + rest;
}

Hub::Taken take(Hub& hub, std::size_t run, BlockKind kind, const std::string& content) {
    return hub.take(run, static_cast<std::uint8_t>(kind), content);
}

std::string block(std::size_t run, BlockKind kind, const std::string& content) {
    std::string bytes(1, static_cast<char>(run));
    view::FrameEncoder::append_block(kind, content, bytes);
    return bytes;
}

std::vector<std::string> beginning_of(const Hub& hub) {
    std::vector<std::string> all;
    for (const SharedMessage& message : hub.beginning())
        all.push_back(message->bytes);
    return all;
}

TEST(Hub, who_comes_later_gets_all_names_and_all_since_the_last_key_frame) {
    Hub hub(2);
    take(hub, 0, BlockKind::names, "first");
    take(hub, 0, BlockKind::key, frame_at(1));
    take(hub, 0, BlockKind::delta, frame_at(2));
    take(hub, 1, BlockKind::key, frame_at(1, "other"));
    take(hub, 0, BlockKind::names, "second");
    take(hub, 0, BlockKind::key, frame_at(3));
    take(hub, 0, BlockKind::delta, frame_at(4));
    EXPECT_THAT(beginning_of(hub),
                ElementsAre(block(0, BlockKind::names, "first"), block(0, BlockKind::names, "second"),
                            block(0, BlockKind::key, frame_at(3)), block(0, BlockKind::delta, frame_at(4)),
                            block(1, BlockKind::key, frame_at(1, "other"))));
}

TEST(Hub, a_block_becomes_the_message_for_those_who_watch_now) {
    Hub hub(2);
    const Hub::Taken taken = take(hub, 1, BlockKind::delta, frame_at(100, "x"));
    EXPECT_EQ(taken.message->kind, Message::Kind::delta);
    EXPECT_EQ(taken.message->run, 1U);
    EXPECT_EQ(taken.message->bytes, block(1, BlockKind::delta, frame_at(100, "x")));
    EXPECT_DOUBLE_EQ(taken.time_s, 0.1);
}

TEST(Hub, names_have_no_time) {
    Hub hub(1);
    EXPECT_LT(take(hub, 0, BlockKind::names, "x").time_s, 0.0);
}

TEST(Hub, times_beyond_one_byte_are_read_too) {
    Hub hub(1);
    // 300,000 ms in groups of seven bits, the lowest first.
    EXPECT_DOUBLE_EQ(take(hub, 0, BlockKind::key, "\xe0\xa7\x12").time_s, 300.0);
}

TEST(Hub, it_has_begun_once_every_run_has_said_who_it_is_and_what_its_network_is) {
    Hub hub(2);
    for (const std::size_t run : {0, 1}) {
        take(hub, run, BlockKind::message, R"({"condition": "c)" + std::to_string(run) + "\"}");
        EXPECT_FALSE(hub.has_begun());
        EXPECT_EQ(take(hub, run, BlockKind::message, "the drawing").message, nullptr);
    }
    EXPECT_TRUE(hub.has_begun());
    const core::Json welcome = core::Json::parse(hub.welcome(true)).at("welcome");
    EXPECT_EQ(welcome.at("format"), view::stream_format);
    EXPECT_EQ(welcome.at("drawing"), "the drawing");
    EXPECT_EQ(welcome.at("runs").at(0).at("condition"), "c0");
    EXPECT_EQ(welcome.at("runs").at(1).at("condition"), "c1");
    EXPECT_TRUE(welcome.at("allow_control").get<bool>());
    EXPECT_TRUE(take(hub, 0, BlockKind::message, "{}").ended);
    EXPECT_THAT(hub.beginning(), IsEmpty());
}

}  // namespace
}  // namespace clearway::server::detail
