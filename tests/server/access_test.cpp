#include "server/access.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "server/browser.hpp"
#include "server/live_show.hpp"
#include "support/message_of.hpp"

namespace clearway::server {
namespace {

using testing::HasSubstr;

const char* const upgrade =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

std::string origin(const std::string& whose) {
    return "Origin: " + whose + "\r\n";
}

class AccessTest : public testing::Test {
  protected:
    void SetUp() override { EXPECT_EQ(get(port, "/").status, 200U) << "the server answers at all"; }

    LiveShow show;
    const std::uint16_t port = show.port();
    const std::string own = fmt::format("http://127.0.0.1:{}", port);
};

TEST_F(AccessTest, the_page_comes_with_headers_that_keep_it_to_itself) {
    const Answer page = get(port, "/");
    EXPECT_THAT(page.body, HasSubstr("data-mode=\"live\""));
    EXPECT_THAT(page.body, HasSubstr("default-src 'none'; script-src 'sha256-"));
    EXPECT_EQ(page.fields.at("X-Frame-Options"), "DENY");
    EXPECT_EQ(page.fields.at("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(page.fields.at("Cache-Control"), "no-store");
    EXPECT_EQ(show.counts().refused, 0U);
}

TEST_F(AccessTest, only_get_is_served) {
    for (const char* const method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE"}) {
        const Answer answer =
            ask(port, fmt::format("{} / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", method, port));
        EXPECT_EQ(answer.status, 405U) << method;
        EXPECT_THAT(answer.body, HasSubstr("only GET"));
    }
    EXPECT_EQ(show.counts().refused, 5U);
}

TEST_F(AccessTest, a_host_that_is_another_name_is_refused) {
    for (const std::string& host : {std::string("evil.example"), fmt::format("evil.example:{}", port),
                                    std::string("127.0.0.1"), fmt::format("127.0.0.1:{}", port + 1),
                                    fmt::format("127.0.0.1:{}.evil.example", port), std::string()}) {
        const Answer answer = get(port, "/", "Host: " + host + "\r\n");
        EXPECT_EQ(answer.status, 403U) << host;
        EXPECT_THAT(answer.body, HasSubstr("Host"));
    }
    EXPECT_EQ(ask(port, "GET / HTTP/1.1\r\n\r\n").status, 403U) << "no host at all";
    EXPECT_EQ(get(port, "/", fmt::format("Host: localhost:{}\r\n", port)).status, 200U);
}

TEST_F(AccessTest, what_is_not_there_is_not_found) {
    for (const char* const target : {"/favicon.ico", "/stream/", "/../etc/passwd", "/stream2", "//"})
        EXPECT_EQ(get(port, target).status, 404U) << target;
}

TEST_F(AccessTest, the_stream_is_for_web_sockets_of_its_own_page) {
    EXPECT_EQ(get(port, "/stream").status, 426U);
    EXPECT_EQ(get(port, "/stream", upgrade).status, 403U) << "no origin";
    for (const std::string& whose :
         {std::string("http://evil.example"), std::string("null"), fmt::format("http://localhost:{}", port),
          own + ".evil.example", fmt::format("https://127.0.0.1:{}", port)})
        EXPECT_EQ(get(port, "/stream", upgrade + origin(whose)).status, 403U) << whose;
    EXPECT_EQ(get(port, "/stream", upgrade + origin(own)).status, 101U);
}

TEST_F(AccessTest, what_is_no_request_or_too_long_is_refused) {
    EXPECT_EQ(ask(port, std::string("\x16\x03\x01\x02\x00\x01 rubbish\r\n\r\n", 22)).status, 400U);
    EXPECT_EQ(get(port, "/", "X-Long: " + std::string(20'000, 'x') + "\r\n").status, 400U);
    EXPECT_EQ(get(port, "/", "Content-Length: 5\r\n").status, 400U) << "a body";
    EXPECT_EQ(get(port, "/").status, 200U) << "and the server lives";
}

TEST(Access, with_a_token_nothing_is_served_without_it) {
    LiveConfig config;
    config.token = "secret";
    LiveShow show(config);
    const std::uint16_t port = show.port();
    const std::string own = origin(fmt::format("http://127.0.0.1:{}", port));
    for (const char* const target :
         {"/", "/?token=", "/?token=wrong", "/?token=secre", "/?token=secret2", "/?x=secret"})
        EXPECT_EQ(get(port, target).status, 401U) << target;
    EXPECT_EQ(get(port, "/stream", upgrade + own).status, 401U);
    EXPECT_EQ(get(port, "/?token=secret").status, 200U);
    EXPECT_EQ(get(port, "/stream?token=secret", upgrade + own).status, 101U);
}

TEST(Access, beyond_this_machine_there_is_no_server_without_a_token) {
    support::TemporaryFolder folder;
    LiveConfig config;
    config.host = "0.0.0.0";
    config.port = 0;
    EXPECT_THAT(support::message_of<core::InputError>([&] { LiveServer(config, folder.path()); }),
                AllOf(HasSubstr("--host"), HasSubstr("0.0.0.0"), HasSubstr("token")));
}

TEST(Access, at_all_addresses_the_one_that_was_reached_is_its_name) {
    LiveConfig config;
    config.host = "0.0.0.0";
    config.token = "secret";
    LiveShow show(config);
    EXPECT_EQ(get(show.port(), "/?token=secret").status, 200U);
    EXPECT_EQ(
        get(show.port(), "/?token=secret", fmt::format("Host: evil.example:{}\r\n", show.port())).status,
        403U);
    const AccessRules rules{"0.0.0.0", 8150, "secret"};
    RequestWords words{.method = "GET",
                       .target = "/?token=secret",
                       .host = "192.0.2.7:8150",
                       .origin = {},
                       .is_upgrade = false,
                       .reached = "192.0.2.7"};
    EXPECT_FALSE(refusal_of(words, rules));
    words.reached = "192.0.2.8";
    EXPECT_EQ(refusal_of(words, rules)->status, 403U);
}

TEST(Access, browsers_leave_out_port_80) {
    const AccessRules rules{"127.0.0.1", 80, ""};
    const RequestWords words{.method = "GET", .target = "/", .host = "127.0.0.1", .origin = {}};
    EXPECT_FALSE(refusal_of(words, rules));
}

TEST(Access, a_token_can_stand_in_an_address_as_it_is) {
    check_token("", "--token");
    check_token("aZ09-._~", "--token");
    check_token(std::string(128, 'x'), "--token");
    for (const std::string& token :
         {std::string("a b"), std::string("a&b"), std::string("a#b"), std::string("100%"),
          std::string("\xc3\xa4"), std::string("a\0b", 3), std::string(129, 'x')})
        EXPECT_THAT(support::message_of<core::InputError>([&] { check_token(token, "--token"); }),
                    AllOf(HasSubstr("--token"), HasSubstr("letters, digits and - . _ ~, 128 at most")))
            << token;
}

TEST(Access, an_address_is_of_this_machine_alone_or_not) {
    EXPECT_TRUE(is_loopback("127.0.0.1", "--host"));
    EXPECT_TRUE(is_loopback("127.3.2.1", "--host"));
    EXPECT_TRUE(is_loopback("::1", "--host"));
    EXPECT_FALSE(is_loopback("0.0.0.0", "--host"));
    EXPECT_FALSE(is_loopback("::", "--host"));
    EXPECT_FALSE(is_loopback("192.0.2.7", "--host"));
    EXPECT_THAT(support::message_of<core::InputError>([] { is_loopback("my-machine", "--host"); }),
                AllOf(HasSubstr("--host"), HasSubstr("my-machine"), HasSubstr("127.0.0.1")));
}

}  // namespace
}  // namespace clearway::server
