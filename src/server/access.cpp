#include "server/access.hpp"

#include <algorithm>
#include <array>

#include <boost/asio/ip/address.hpp>
#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::server {
namespace {

/// Compares without telling by its time how much was right.
bool same_secret(std::string_view one, std::string_view other) {
    unsigned difference = one.size() == other.size() ? 0U : 1U;
    for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i)
        difference |=
            static_cast<unsigned>(static_cast<unsigned char>(one[i]) ^ static_cast<unsigned char>(other[i]));
    return difference == 0;
}

std::string in_brackets(const std::string& address) {
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

/// Whether a `Host` header means this server. Browsers leave out port 80.
bool is_own_name(std::string_view host, const std::string& reached, const AccessRules& rules) {
    constexpr std::uint16_t usual_port = 80;
    const std::array names = {in_brackets(rules.host), in_brackets(reached), std::string("localhost"),
                              std::string("127.0.0.1"), std::string("[::1]")};
    return std::ranges::any_of(names, [&](const std::string& name) {
        return host == fmt::format("{}:{}", name, rules.port) || (rules.port == usual_port && host == name);
    });
}

}  // namespace

std::optional<Refusal> refusal_of(const RequestWords& request, const AccessRules& rules) {
    constexpr unsigned unauthorised = 401;
    constexpr unsigned forbidden = 403;
    constexpr unsigned not_found = 404;
    constexpr unsigned not_allowed = 405;
    constexpr unsigned upgrade_required = 426;
    if (request.method != "GET") return Refusal{not_allowed, "only GET is served"};
    if (!request.host || !is_own_name(*request.host, request.reached, rules))
        return Refusal{forbidden, "Host is not this server"};
    const std::string_view path = request.target.substr(0, request.target.find('?'));
    if (path != "/" && path != "/stream") return Refusal{not_found, "there are / and /stream"};
    const std::size_t query = request.target.find('?');
    constexpr std::string_view key = "token=";
    const std::string_view words = query == std::string_view::npos ? "" : request.target.substr(query + 1);
    const std::string_view token = words.starts_with(key) ? words.substr(key.size()) : "";
    if (!rules.token.empty() && !same_secret(token, rules.token))
        return Refusal{unauthorised,
                       "the token is missing or wrong: open the address that clearway live printed"};
    if (path == "/") return std::nullopt;
    if (!request.is_upgrade) return Refusal{upgrade_required, "/stream is a WebSocket"};
    if (!request.origin || *request.origin != fmt::format("http://{}", *request.host))
        return Refusal{forbidden, "Origin is not this server's page"};
    return std::nullopt;
}

void check_token(const std::string& token, const std::string& where) {
    constexpr std::size_t longest = 128;
    constexpr std::string_view allowed =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";  // unreserved, RFC 3986, 2.3
    if (token.size() <= longest && token.find_first_not_of(allowed) == std::string::npos) return;
    throw core::InputError({where, "the token cannot stand in an address as it is",
                            fmt::format("letters, digits and - . _ ~, {} at most", longest),
                            "Without --token one is drawn where it is needed"});
}

bool is_loopback(const std::string& address, const std::string& where) {
    boost::system::error_code error;
    const auto parsed = boost::asio::ip::make_address(address, error);
    if (error)
        throw core::InputError({where, fmt::format("`{}` is not an address", address),
                                "an IPv4 or IPv6 address", "127.0.0.1 is this machine alone"});
    return parsed.is_loopback();
}

}  // namespace clearway::server
