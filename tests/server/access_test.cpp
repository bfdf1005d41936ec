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
    EXPECT_EQ(ask(port, std::string("\x16\x03\x01\x02\x00\x01 rubbish\r\n\r\n", 18)).status, 400U);
    EXPECT_EQ(get(port, "/", "X-Long: " + std::string(20'000, 'x') + "\r\n").status, 400U);
    EXPECT_EQ(get(port, "/", "Content-Length: 5\r\n").status, 400U) << "a body";
    EXPECT_EQ(get(port, "/").status, 200U) << "and the server lives";
}

TEST(Access, with_a_token_nothing_is_served_without_it) {
    LiveConfig config;
    config.token = "secret-of-sixteen";
    LiveShow show(config);
    const std::uint16_t port = show.port();
    const std::string own = origin(fmt::format("http://127.0.0.1:{}", port));
    for (const char* const target : {"/", "/?token=", "/?token=wrong", "/?token=secret-of-sixtee",
                                     "/?token=secret-of-sixteen2", "/?x=secret-of-sixteen"})
        EXPECT_EQ(get(port, target).status, 401U) << target;
    EXPECT_EQ(get(port, "/stream", upgrade + own).status, 401U);
    EXPECT_EQ(get(port, "/?token=secret-of-sixteen").status, 200U);
    EXPECT_EQ(get(port, "/stream?token=secret-of-sixteen", upgrade + own).status, 101U);
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
    config.token = "secret-of-sixteen";
    LiveShow show(config);
    EXPECT_EQ(get(show.port(), "/?token=secret-of-sixteen").status, 200U);
    EXPECT_EQ(
        get(show.port(), "/?token=secret-of-sixteen", fmt::format("Host: evil.example:{}\r\n", show.port()))
            .status,
        403U);
    const AccessRules rules{"0.0.0.0", 8150, "secret"};  // the rules take whatever they are given
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
    check_token("aZ09-._~aZ09-._~", "--token");
    check_token(std::string(128, 'x'), "--token");
    for (const std::string& token :
         {std::string("a b"), std::string("a&b"), std::string("a#b"), std::string("100%"),
          std::string("\xc3\xa4"), std::string("a\0b", 3), std::string(129, 'x')})
        EXPECT_THAT(support::message_of<core::InputError>([&] { check_token(token, "--token"); }),
                    AllOf(HasSubstr("--token"), HasSubstr("letters, digits and - . _ ~, 16 to 128 of them")))
            << token;
}

TEST(Access, a_token_that_can_be_guessed_is_refused) {
    for (const std::size_t length : {1, 8, 15})
        EXPECT_THAT(
            support::message_of<core::InputError>([&] { check_token(std::string(length, 'x'), "--token"); }),
            AllOf(HasSubstr("--token"), HasSubstr(fmt::format("a token of {} characters", length)),
                  HasSubstr("16 to 128")));
    support::TemporaryFolder folder;
    LiveConfig config;
    config.token = "a";
    EXPECT_THROW(LiveServer(config, folder.path()), core::InputError);
}

TEST(Access, names_of_this_machine_are_taken_with_a_token_alone) {
    AccessRules rules{"0.0.0.0", 8150, "secret", {"desk.example.org", "desk"}};
    RequestWords words{.method = "GET", .target = "/?token=secret", .host = {}, .origin = {}};
    const auto status_with = [&](const char* host) {
        words.host = host;
        const auto refusal = refusal_of(words, rules);
        return refusal ? refusal->status : 200U;
    };
    for (const char* const host : {"desk:8150", "desk.example.org:8150", "DESK:8150"})
        EXPECT_EQ(status_with(host), 200U) << host;
    for (const char* const host : {"desk", "desk:8151", "disk:8150", "desk.evil.example:8150"})
        EXPECT_EQ(status_with(host), 403U) << host;
    words.target = "/";
    EXPECT_EQ(status_with("desk:8150"), 401U) << "the token is needed all the same";
    rules.token.clear();
    EXPECT_EQ(status_with("desk:8150"), 403U) << "a page elsewhere could bear that name";
}

TEST(Access, a_server_answers_to_the_name_of_its_machine) {
    const std::vector<std::string> names = own_names();
    if (names.empty()) GTEST_SKIP() << "this machine has no name";
    LiveConfig config;
    config.host = "0.0.0.0";
    config.token = "secret-of-sixteen";
    LiveShow show(config);
    for (const std::string& name : names) {
        const std::string host = fmt::format("Host: {}:{}\r\n", name, show.port());
        EXPECT_EQ(get(show.port(), "/?token=secret-of-sixteen", host).status, 200U) << name;
        const std::string own = origin(fmt::format("http://{}:{}", name, show.port()));
        EXPECT_EQ(get(show.port(), "/stream?token=secret-of-sixteen", host + upgrade + own).status, 101U);
        EXPECT_EQ(get(show.port(), "/", host).status, 401U);
    }
    LiveShow without;
    EXPECT_EQ(get(without.port(), "/", fmt::format("Host: {}:{}\r\n", names[0], without.port())).status,
              403U);
}

TEST(Access, a_name_can_be_listened_at) {
    LiveConfig config;
    config.host = "localhost";
    LiveShow show(config);
    EXPECT_EQ(get(show.port(), "/").status, 200U);
    EXPECT_EQ(pages_of("localhost", 8150, ""), std::vector<std::string>{"http://localhost:8150/"});
}

TEST(Access, what_is_printed_can_be_opened) {
    EXPECT_EQ(pages_of("127.0.0.1", 80, ""), std::vector<std::string>{"http://127.0.0.1:80/"});
    EXPECT_EQ(pages_of("::1", 8150, "x"), std::vector<std::string>{"http://[::1]:8150/?token=x"});
    for (const char* const everywhere : {"0.0.0.0", "::"}) {
        const std::vector<std::string> pages = pages_of(everywhere, 8150, "secret");
        EXPECT_EQ(pages.back(), "http://127.0.0.1:8150/?token=secret");
        for (const std::string& page : pages) {
            EXPECT_THAT(page,
                        AllOf(testing::StartsWith("http://"), testing::EndsWith(":8150/?token=secret")));
            EXPECT_THAT(page, Not(AnyOf(HasSubstr("//0.0.0.0:"), HasSubstr("//[::]:")))) << everywhere;
        }
        for (const std::string& name : own_names())
            EXPECT_THAT(pages, testing::Contains(fmt::format("http://{}:8150/?token=secret", name)));
    }
}

TEST(Access, an_address_is_of_this_machine_alone_or_not) {
    EXPECT_TRUE(is_loopback("127.0.0.1", "--host"));
    EXPECT_TRUE(is_loopback("127.3.2.1", "--host"));
    EXPECT_TRUE(is_loopback("::1", "--host"));
    EXPECT_FALSE(is_loopback("0.0.0.0", "--host"));
    EXPECT_FALSE(is_loopback("::", "--host"));
    EXPECT_FALSE(is_loopback("192.0.2.7", "--host"));
    EXPECT_TRUE(is_loopback("localhost", "--host"));
    EXPECT_THAT(support::message_of<core::InputError>([] { is_loopback("my..machine", "--host"); }),
                AllOf(HasSubstr("--host"), HasSubstr("`my..machine` is neither an address nor a known name"),
                      HasSubstr("127.0.0.1")));
}

}  // namespace
}  // namespace clearway::server
