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

/// Shows runs that happen in other processes: those connect to a local socket, hand over the blocks of their
/// streams and wait until they may go on; browsers get the page and a WebSocket. One thread, one event loop.
///
/// A client has a queue of bounded size. When it is full, frames are left out until the next key frame, and
/// counted: no client slows a run or another client. Requests, headers and messages have limits of size and
/// time; see access.hpp for who is refused.
class LiveServer {
  public:
    /// Listens for runs at `socket` and for browsers. Throws core::EnvironmentError for a port that is taken
    /// or an address that is not of this machine.
    LiveServer(const LiveConfig& config, const std::filesystem::path& socket);
    ~LiveServer();
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;

    /// As bound.
    std::uint16_t port() const;
    /// Serves until all runs have ended and the last client has left, or until `stop` says so, which is asked
    /// some 20 times a second.
    void run(const std::function<bool()>& stop);
    LiveCounts counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::server
