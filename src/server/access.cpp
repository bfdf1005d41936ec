#include "server/access.hpp"

#include <algorithm>
#include <array>

#include <arpa/inet.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <unistd.h>

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

/// Names are the same in small and capital letters.
bool same_name(std::string_view one, std::string_view other) {
    const auto small = [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter;
    };
    return std::ranges::equal(one, other, {}, small, small);
}

/// Whether a `Host` header means this server. Browsers leave out port 80.
bool is_own_name(std::string_view host, const std::string& reached, const AccessRules& rules) {
    constexpr std::uint16_t usual_port = 80;
    std::vector<std::string> names = {in_brackets(rules.host), in_brackets(reached), "localhost", "127.0.0.1",
                                      "[::1]"};
    if (!rules.token.empty()) names.insert(names.end(), rules.names.begin(), rules.names.end());
    return std::ranges::any_of(names, [&](const std::string& name) {
        return same_name(host, fmt::format("{}:{}", name, rules.port)) ||
               (rules.port == usual_port && same_name(host, name));
    });
}

bool is_wildcard(const std::string& host) {
    boost::system::error_code error;
    const auto parsed = boost::asio::ip::make_address(host, error);
    return !error && parsed.is_unspecified();
}

std::string text_of(const sockaddr& address) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    const void* const bytes =
        address.sa_family == AF_INET
            ? static_cast<const void*>(&reinterpret_cast<const sockaddr_in&>(address).sin_addr)
            : static_cast<const void*>(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
    return ::inet_ntop(address.sa_family, bytes, text.data(), text.size()) == nullptr ? "" : text.data();
}

/// Addresses of the network interfaces that are up, without those that mean this machine alone and without
/// link-local ones, which an address line cannot hold.
std::vector<std::string> interface_addresses(int family) {
    std::vector<std::string> found;
    ifaddrs* all = nullptr;
    if (::getifaddrs(&all) != 0) return found;
    for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
        if (one->ifa_addr == nullptr || (one->ifa_flags & IFF_UP) == 0) continue;
        const bool is_meant =
            one->ifa_addr->sa_family == family || (family == AF_INET6 && one->ifa_addr->sa_family == AF_INET);
        if (!is_meant) continue;
        boost::system::error_code error;
        const auto parsed = boost::asio::ip::make_address(text_of(*one->ifa_addr), error);
        if (error || parsed.is_loopback() || (parsed.is_v6() && parsed.to_v6().is_link_local())) continue;
        found.push_back(parsed.to_string());
    }
    ::freeifaddrs(all);
    return found;
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
    if (path != "/" && path != "/stream") return Refusal{not_found, "only / and /stream are served"};
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
    constexpr std::size_t shortest = 16;  // 64 bits even if only sixteen letters are used, as for hex digits
    constexpr std::size_t longest = 128;
    constexpr std::string_view allowed =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";  // unreserved, RFC 3986, 2.3
    if (token.empty()) return;
    const bool can_stand = token.find_first_not_of(allowed) == std::string::npos && token.size() <= longest;
    if (can_stand && token.size() >= shortest) return;
    throw core::InputError({where,
                            can_stand ? fmt::format("a token of {} characters can be guessed", token.size())
                                      : "the token has characters that are not allowed in an address",
                            fmt::format("letters, digits and - . _ ~, {} to {} of them", shortest, longest),
                            "Without --token, one is generated where it is needed"});
}

std::vector<std::string> addresses_of(const std::string& host, const std::string& where) {
    boost::system::error_code error;
    boost::asio::ip::make_address(host, error);
    if (!error) return {host};
    boost::asio::io_context loop;
    boost::asio::ip::tcp::resolver resolver(loop);
    std::vector<std::string> found = core::texts_of(resolver.resolve(host, "", error), [](const auto& entry) {
        return entry.endpoint().address().to_string();
    });
    if (error || found.empty())
        throw core::InputError({where, fmt::format("`{}` is neither an address nor a known name", host),
                                "an IPv4 or IPv6 address, or a name of this machine",
                                "127.0.0.1 is this machine alone"});
    return found;
}

bool is_loopback(const std::string& host, const std::string& where) {
    return std::ranges::all_of(addresses_of(host, where), [](const std::string& address) {
        return boost::asio::ip::make_address(address).is_loopback();
    });
}

std::vector<std::string> own_names() {
    std::array<char, HOST_NAME_MAX + 1> text{};
    if (::gethostname(text.data(), text.size() - 1) != 0) return {};
    const std::string whole = text.data();
    std::vector<std::string> names;
    for (const std::string& name : {whole, whole.substr(0, whole.find('.'))}) {
        if (!name.empty() && !core::contains(names, name)) names.push_back(name);
    }
    return names;
}

std::vector<std::string> pages_of(const std::string& host, std::uint16_t port, const std::string& token) {
    std::vector<std::string> places = {host};
    if (is_wildcard(host)) {
        places = interface_addresses(host.find(':') == std::string::npos ? AF_INET : AF_INET6);
        for (const std::string& name : own_names())
            places.push_back(name);
        places.emplace_back("127.0.0.1");
    }
    std::vector<std::string> pages;
    for (const std::string& place : places)
        pages.push_back(
            fmt::format("http://{}:{}/{}", in_brackets(place), port, token.empty() ? "" : "?token=" + token));
    return pages;
}

}  // namespace clearway::server
