#include "loop/detail/live_feed.hpp"

#include <cerrno>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/units.hpp"

namespace clearway::loop::detail {
namespace {

[[noreturn]] void server_is_gone() {
    throw core::Error(core::ExitCode::incomplete,
                      "the server that showed the run is gone; its results are discarded");
}

sockaddr_un address_of(const std::filesystem::path& socket) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = socket.string();
    if (path.size() >= sizeof address.sun_path)
        throw core::EnvironmentError(fmt::format("{}: too long for a local socket", path));
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    return address;
}

}  // namespace

LiveFeed::LiveFeed(const std::filesystem::path& socket)
    : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)),
      allowed_s_(-std::numeric_limits<double>::infinity()) {
    const sockaddr_un address = address_of(socket);
    if (socket_ >= 0 && ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
        return;
    const int reason = errno;
    if (socket_ >= 0) ::close(socket_);
    throw core::EnvironmentError(fmt::format("{}: no server: {}", socket.string(), std::strerror(reason)));
}

LiveFeed::~LiveFeed() {
    ::close(socket_);
}

void LiveFeed::send(std::string_view blocks) const {
    while (!blocks.empty()) {
        const ssize_t sent = ::send(socket_, blocks.data(), blocks.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) server_is_gone();
        blocks.remove_prefix(static_cast<std::size_t>(sent));
    }
}

void LiveFeed::wait_until_allowed(double time_s) {
    while (time_s >= allowed_s_ - core::clock_tolerance_s) {
        double allowed_s = 0.0;
        const ssize_t got = ::recv(socket_, &allowed_s, sizeof allowed_s, MSG_WAITALL);
        if (got < 0 && errno == EINTR) continue;
        if (got != sizeof allowed_s) server_is_gone();
        allowed_s_ = allowed_s;
    }
}

}  // namespace clearway::loop::detail
