#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace clearway::server {

/// Who may watch, and who may control.
struct AccessRules {
    std::string host = "127.0.0.1";  ///< Address that the server listens at; 0.0.0.0 or :: mean all of them.
    std::uint16_t port = 0;          ///< As bound.
    std::string token;               ///< Empty: none is asked for. Never empty beyond this machine.
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
/// is needed. `Host` must be an address of this server or `localhost`, with its port, so that no foreign name
/// leads here; a WebSocket must come from this server's own page (`Origin`). Pure.
std::optional<Refusal> refusal_of(const RequestWords& request, const AccessRules& rules);

/// Throws core::InputError, naming `where`, for a token that an address cannot carry as it is: letters,
/// digits and `-._~`, 128 at most. An empty one means none.
void check_token(const std::string& token, const std::string& where);

/// Whether an address means this machine alone. Throws core::InputError, naming `where`, for text that is no
/// address.
bool is_loopback(const std::string& address, const std::string& where);

}  // namespace clearway::server
