#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/local/stream_protocol.hpp>

namespace clearway::server::detail {

/// Reads one number of a stream (view::BlockKind). False when it is not whole yet, or has no end.
bool read_number(std::string_view bytes, std::size_t& at, std::uint64_t& value);

/// The server's end of the connection to a run: reads blocks, writes times up to which it may go.
class Feed : public std::enable_shared_from_this<Feed> {
  public:
    using Socket = boost::asio::local::stream_protocol::socket;
    struct Events {
        std::function<void(std::uint8_t kind, std::string_view content)> block;
        std::function<void()> closed;
    };
    Feed(Socket socket, Events events) : socket_(std::move(socket)), events_(std::move(events)) {}

    void start() { read(); }
    /// Tells the run how far it may go. What it was told before need not have been read.
    void allow(double time_s);

  private:
    void read();
    /// Hands over the whole blocks and keeps the rest.
    void take_blocks();

    Socket socket_;
    Events events_;
    std::array<char, 65536> chunk_{};
    std::string pending_;
    double allowed_s_ = 0.0, sent_s_ = 0.0;
    bool is_writing_ = false;
};

}  // namespace clearway::server::detail
