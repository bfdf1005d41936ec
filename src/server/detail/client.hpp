#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "server/access.hpp"
#include "server/detail/hub.hpp"
#include "server/live_server.hpp"

namespace clearway::server::detail {

/// One connection of a browser: it asks for the page, or becomes a WebSocket that watches.
class Client : public std::enable_shared_from_this<Client> {
  public:
    using Socket = boost::asio::ip::tcp::socket;
    /// What clients share; outlives them.
    struct Host {
        const AccessRules& rules;
        std::string page;
        bool allow_control = false;
        LiveCounts& counts;
        std::size_t& connections;  ///< That are open now, whatever they ask for.
        std::function<bool(const std::shared_ptr<Client>&)> joined;  ///< False: there are too many.
        std::function<void(const std::string&)> control;             ///< Throws std::exception for bad words.
    };
    Client(Socket socket, const Host& host)
        : socket_(boost::beast::tcp_stream(std::move(socket))), host_(host) {
        ++host_.connections;
    }
    ~Client() { --host_.connections; }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void start();
    /// Queues a message, or leaves out a frame where the queue is full.
    void send(const SharedMessage& message);
    /// JSON words; always queued.
    void say(std::string words);
    /// Takes no more messages, and closes once the queue is empty.
    void finish();
    bool is_open() const { return is_open_; }
    std::uint64_t dropped() const { return dropped_; }

  private:
    using Request = boost::beast::http::request<boost::beast::http::empty_body>;
    void answer(const Request& request);
    void answer(unsigned status, std::string text, const char* type);
    void upgrade(const Request& request);
    void read();
    void take(const std::string& words);
    void write();
    void close_when_sent();
    void close(boost::beast::websocket::close_code code, const char* why);

    boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
    const Host& host_;
    boost::beast::flat_buffer buffer_;
    std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
    boost::beast::http::response<boost::beast::http::string_body> response_;
    std::deque<SharedMessage> queue_;
    std::size_t queued_bytes_ = 0;
    std::vector<bool> waits_for_key_;
    std::uint64_t dropped_ = 0;
    bool is_open_ = false, is_finishing_ = false;
};

}  // namespace clearway::server::detail
