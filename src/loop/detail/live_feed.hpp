#pragma once

#include <filesystem>
#include <string_view>

namespace clearway::loop::detail {

/// The run's end of the connection to a server (server/live_server.hpp): blocks of a stream go there, and
/// times up to which the run may go, 8 bytes each in the machine's order, come back.
class LiveFeed {
  public:
    /// Connects. Throws core::EnvironmentError when no server listens there.
    explicit LiveFeed(const std::filesystem::path& socket);
    ~LiveFeed();
    LiveFeed(const LiveFeed&) = delete;
    LiveFeed& operator=(const LiveFeed&) = delete;

    /// Throws core::Error with code incomplete when the server is gone; so does the other.
    void send(std::string_view blocks) const;
    /// Returns once the run may go beyond `time_s`.
    void wait_until_allowed(double time_s);

  private:
    int socket_;
    double allowed_s_;
};

}  // namespace clearway::loop::detail
