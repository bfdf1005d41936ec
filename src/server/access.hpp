#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::server {

/// Which viewers may watch, and which may control.
struct AccessRules {
    std::string host = "127.0.0.1";  ///< Address or name that it listens at; 0.0.0.0 or :: mean all of them.
    std::uint16_t port = 0;          ///< As bound.
    std::string token;               ///< Empty: none is asked for. Never empty beyond this machine.
    /// Names of this machine, taken only with a token: a page elsewhere whose name was led here knows none.
    std::vector<std::string> names = {};
};

/// What a request says of itself.
struct RequestWords {
    std::string_view method, target;
    std::optional<std::string_view> host, origin;
    bool is_upgrade = false;
    std::string reached = {};  ///< Address of this machine at which the connection arrived.
};

/// Why a request is refused.
struct Refusal {
    unsigned status = 0;  ///< HTTP's.
    std::string why;
};

/// Nothing for a request that is served: `/` as a page or `/stream` as a WebSocket, with `?token=` where one
/// is needed. `Host` must be what the server was told to listen at, the address that was reached,
/// `localhost`, or, with a token, a name of this machine, with its port, so that no foreign name leads here;
/// a WebSocket must come from this server's own page (`Origin`). Pure.
std::optional<Refusal> refusal_of(const RequestWords& request, const AccessRules& rules);

/// Throws core::InputError, naming `where`, for a token that an address cannot carry as it is: letters,
/// digits and `-._~`, 128 at most; or that can be guessed: 16 at least. An empty one means none.
void check_token(const std::string& token, const std::string& where);

/// Addresses of this machine that `host` stands for: itself if it is an address, else what its name resolves
/// to. Never empty. Throws core::InputError, naming `where`, for a name that is not known.
std::vector<std::string> addresses_of(const std::string& host, const std::string& where);

/// Whether all addresses that `host` stands for mean this machine alone. Throws as addresses_of.
bool is_loopback(const std::string& host, const std::string& where);

/// This machine's own name, as it is set and without its domain; empty where it has none.
std::vector<std::string> own_names();

/// What others open to reach a server that listens at `host`: `http://...`, the surest first. For 0.0.0.0 and
/// :: these are this machine's names and the addresses of its network interfaces.
std::vector<std::string> pages_of(const std::string& host, std::uint16_t port, const std::string& token);

}  // namespace clearway::server
