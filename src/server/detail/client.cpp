#include "server/detail/client.hpp"

#include <chrono>

#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

namespace clearway::server::detail {
namespace {

namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;

constexpr std::uint32_t most_header_bytes = 8192;
constexpr std::size_t most_message_bytes = 1024;
/// Frames wait in a queue up to this.
constexpr std::size_t most_queued_bytes = std::size_t{4} << 20U;
/// Names and words, which cannot be left out, wait up to this; the drawing of a large city is some 10 MB.
constexpr std::size_t most_waiting_bytes = std::size_t{64} << 20U;
constexpr std::chrono::seconds patience{10};

template <class Fields>
std::optional<std::string_view> field_of(const Fields& fields, http::field name) {
    const auto at = fields.find(name);
    if (at == fields.end()) return std::nullopt;
    return std::string_view(at->value().data(), at->value().size());
}

}  // namespace

void Client::start() {
    parser_.emplace();
    parser_->header_limit(most_header_bytes);
    parser_->body_limit(0);
    boost::beast::get_lowest_layer(socket_).expires_after(patience);
    http::async_read(socket_.next_layer(), buffer_, *parser_,
                     [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
                         if (!error) return self->answer(self->parser_->get());
                         if (error == http::error::end_of_stream || error == boost::beast::error::timeout)
                             return;
                         constexpr unsigned bad_request = 400;
                         self->answer(bad_request, "not a request that this server reads\n", "text/plain");
                     });
}

void Client::answer(const Request& request) {
    boost::system::error_code unknown;
    const auto here = boost::beast::get_lowest_layer(socket_).socket().local_endpoint(unknown);
    const RequestWords words{.method = {request.method_string().data(), request.method_string().size()},
                             .target = {request.target().data(), request.target().size()},
                             .host = field_of(request, http::field::host),
                             .origin = field_of(request, http::field::origin),
                             .is_upgrade = websocket::is_upgrade(request),
                             .reached = unknown ? std::string() : here.address().to_string()};
    if (const auto refusal = refusal_of(words, host_.rules))
        return answer(refusal->status, refusal->why + "\n", "text/plain; charset=utf-8");
    constexpr unsigned ok = 200;
    if (words.target.substr(0, words.target.find('?')) == "/")
        return answer(ok, host_.page, "text/html; charset=utf-8");
    upgrade(request);
}

void Client::answer(unsigned status, std::string text, const char* type) {
    constexpr unsigned first_refusal = 400;
    if (status >= first_refusal) ++host_.counts.refused;
    response_ = {http::int_to_status(status), 11};
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("X-Frame-Options", "DENY");
    response_.set("Referrer-Policy", "no-referrer");
    response_.keep_alive(false);
    response_.body() = std::move(text);
    response_.prepare_payload();
    boost::beast::get_lowest_layer(socket_).expires_after(patience);
    http::async_write(socket_.next_layer(), response_,
                      [self = shared_from_this()](const boost::system::error_code&, std::size_t) {
                          boost::system::error_code ignored;
                          boost::beast::get_lowest_layer(self->socket_)
                              .socket()
                              .shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
                      });
}

void Client::upgrade(const Request& request) {
    constexpr unsigned unavailable = 503;
    if (!host_.joined(shared_from_this())) return answer(unavailable, "too many viewers\n", "text/plain");
    boost::beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout::suggested(boost::beast::role_type::server));
    socket_.read_message_max(most_message_bytes);
    is_open_ = true;
    socket_.async_accept(request, [self = shared_from_this()](const boost::system::error_code& error) {
        if (error) {
            self->is_open_ = false;
            return;
        }
        self->parser_.reset();
        self->read();
        if (!self->queue_.empty()) return self->write();
        if (self->is_finishing_) self->close_when_sent();
    });
}

void Client::read() {
    buffer_.clear();
    socket_.async_read(buffer_,
                       [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
                           if (error) {
                               self->is_open_ = false;
                               return;
                           }
                           const auto data = self->buffer_.data();
                           self->take({static_cast<const char*>(data.data()), data.size()});
                       });
}

void Client::take(const std::string& words) {
    if (!host_.allow_control)
        return close(websocket::close_code::policy_error, "read-only: started without --allow-control");
    try {
        host_.control(words);
    } catch (const std::exception&) {
        return close(websocket::close_code::bad_payload, "words that are not known");
    }
    read();
}

void Client::close(websocket::close_code code, const char* why) {
    ++host_.counts.refused;
    is_open_ = false;
    socket_.async_close({code, why}, [self = shared_from_this()](const boost::system::error_code&) {});
}

void Client::send(const SharedMessage& message) {
    using Kind = Message::Kind;
    if (!is_open_ || is_finishing_) return;
    if (waits_for_key_.size() <= message->run) waits_for_key_.resize(message->run + 1, false);
    const bool is_frame = message->kind == Kind::key || message->kind == Kind::delta;
    if (is_frame) {
        const bool fits = queued_bytes_ + message->bytes.size() <= most_queued_bytes;
        if (!fits || (waits_for_key_[message->run] && message->kind == Kind::delta)) {
            waits_for_key_[message->run] = true;
            ++dropped_;
            ++host_.counts.frames_dropped;
            return;
        }
        waits_for_key_[message->run] = false;
        ++host_.counts.frames_sent;
    } else if (queued_bytes_ > most_waiting_bytes) {
        is_open_ = false;  // It reads nothing at all.
        boost::beast::get_lowest_layer(socket_).close();
        return;
    }
    const bool is_idle = queue_.empty();
    queue_.push_back(message);
    queued_bytes_ += message->bytes.size();
    if (is_idle && !parser_) write();
}

void Client::say(std::string words) {
    send(std::make_shared<const Message>(Message{Message::Kind::words, 0, std::move(words)}));
}

void Client::finish() {
    if (is_finishing_) return;
    is_finishing_ = true;
    close_when_sent();
}

void Client::close_when_sent() {
    if (queue_.empty() && is_open_ && !parser_)
        socket_.async_close(
            websocket::close_code::normal,
            [self = shared_from_this()](const boost::system::error_code&) { self->is_open_ = false; });
}

void Client::write() {
    const SharedMessage message = queue_.front();
    socket_.text(message->kind == Message::Kind::words);
    socket_.async_write(
        boost::asio::buffer(message->bytes),
        [self = shared_from_this(), message](const boost::system::error_code& error, std::size_t) {
            if (error) {
                self->is_open_ = false;
                return;
            }
            self->queued_bytes_ -= message->bytes.size();
            self->queue_.pop_front();
            if (!self->queue_.empty()) return self->write();
            if (self->is_finishing_) self->close_when_sent();
        });
}

}  // namespace clearway::server::detail
