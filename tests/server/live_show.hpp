#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "server/live_server.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::server {

/// The end of a connection that a run has: it says who it is, sends frames, and waits where the server says.
class FakeRun {
  public:
    FakeRun(const std::filesystem::path& socket, const std::string& condition);
    ~FakeRun() { close(); }
    FakeRun(FakeRun&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
    FakeRun(const FakeRun&) = delete;
    FakeRun& operator=(const FakeRun&) = delete;
    FakeRun& operator=(FakeRun&&) = delete;

    /// A key frame that says its time and carries `bytes` more.
    void key(double time_s, std::size_t bytes = 0) const { frame(2, time_s, bytes); }
    void delta(double time_s, std::size_t bytes = 0) const { frame(3, time_s, bytes); }
    /// The next time up to which it may go, s.
    double allowed() const;
    /// Whether the server has said something that was not read yet, within so many milliseconds.
    bool is_told_within(int milliseconds) const;
    void close();

  private:
    void frame(int kind, double time_s, std::size_t bytes) const;
    void send(const std::string& bytes) const;

    int socket_ = -1;
};

/// A server in a thread of its own, at a port of this machine that is free, with no runs yet.
class LiveShow {
  public:
    explicit LiveShow(LiveConfig config = {});
    ~LiveShow();
    LiveShow(const LiveShow&) = delete;
    LiveShow& operator=(const LiveShow&) = delete;

    std::uint16_t port() const { return server_->port(); }
    FakeRun run(std::size_t number, const std::string& condition) const;
    /// Waits until the server has come to its end by itself; false after 20 s.
    bool ends() const;
    /// Ends the server and returns what it did.
    LiveCounts counts();

  private:
    support::TemporaryFolder folder_;
    std::unique_ptr<LiveServer> server_;
    std::atomic<bool> stop_ = false, has_ended_ = false;
    std::thread thread_;
};

}  // namespace clearway::server
