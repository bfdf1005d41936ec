#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "core/json.hpp"

namespace clearway::server {

/// What a server answered to an HTTP request.
struct Answer {
    unsigned status = 0;
    std::string body;
    std::map<std::string, std::string> fields;
};

/// Sends bytes as they are over a new connection and reads what comes back until it ends.
Answer ask(std::uint16_t port, const std::string& request);
/// `GET TARGET` with these further header lines, each ended with `\r\n`; `Host` is this server if none is
/// given.
Answer get(std::uint16_t port, const std::string& target, const std::string& headers = "");

/// A browser that watches, over a real connection.
class Viewer {
  public:
    explicit Viewer(std::uint16_t port, const std::string& target = "/stream");
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    struct Heard {
        bool is_text = false;
        std::string bytes;
    };
    /// The next message; nothing once the server has closed the connection.
    std::optional<Heard> next();
    /// Reads until words of this name come, and returns them; frames go by.
    core::Json words(const std::string& name);
    void say(const std::string& words);
    void say_bytes(const std::string& bytes);
    /// Why the server has closed, after `next` gave nothing.
    unsigned close_code() const { return socket_.reason().code; }
    std::string close_reason() const {
        return {socket_.reason().reason.data(), socket_.reason().reason.size()};
    }

  private:
    boost::asio::io_context loop_;
    boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
};

}  // namespace clearway::server
