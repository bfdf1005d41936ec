#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace clearway::server {

/// How a live run is served.
struct LiveConfig {
    std::string host = "127.0.0.1";
    std::uint16_t port = 8150;  ///< 0: any that is free.
    std::string token;          ///< Needed beyond this machine.
    bool allow_control = false;
    double speed = 5.0;  ///< Times real time; 0: as fast as possible.
    std::size_t runs = 1;
    std::string title;
};

/// What a server did.
struct LiveCounts {
    std::uint64_t clients = 0;  ///< That watched.
    std::uint64_t refused = 0;
    std::uint64_t frames_sent = 0;
    std::uint64_t frames_dropped = 0;  ///< Because a client was too slow.
};

/// The local socket at which a server waits for one of its runs; `folder` should have a short name.
std::filesystem::path socket_of(const std::filesystem::path& folder, std::size_t run);

/// Shows runs that happen in other processes: each connects to a local socket of its own, hands over the
/// blocks of its stream and waits until it may go on; browsers get the page and a WebSocket. One thread, one
/// event loop.
///
/// A client has a queue of bounded size. When it is full, frames are left out until the next key frame, and
/// counted: no client slows a run or another client. Requests, headers and messages have limits of size and
/// time; see access.hpp for which requests are refused.
class LiveServer {
  public:
    /// Listens for runs in `sockets`, a folder, and for browsers. Throws core::EnvironmentError for a port
    /// that is taken or an address that is not of this machine, core::InputError for one that others can
    /// reach without a token and for a token that an address cannot carry.
    LiveServer(const LiveConfig& config, const std::filesystem::path& sockets);
    ~LiveServer();
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;

    /// As bound.
    std::uint16_t port() const;
    /// Serves until all runs have ended and every client has what was queued for it, 10 s later at the most,
    /// or until `stop` says so, which is asked some 50 times a second. What they saw, clients keep.
    void run(const std::function<bool()>& stop);
    LiveCounts counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::server
