#include "server/browser.hpp"

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <fmt/format.h>

namespace clearway::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

asio::ip::tcp::endpoint at(std::uint16_t port) {
    return {asio::ip::make_address("127.0.0.1"), port};
}

}  // namespace

Answer ask(std::uint16_t port, const std::string& request) {
    asio::io_context loop;
    asio::ip::tcp::socket socket(loop);
    socket.connect(at(port));
    asio::write(socket, asio::buffer(request));
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    http::read(socket, buffer, parser);
    Answer answer{parser.get().result_int(), parser.get().body(), {}};
    for (const auto& field : parser.get())
        answer.fields[std::string(field.name_string().data(), field.name_string().size())] =
            std::string(field.value().data(), field.value().size());
    return answer;
}

Answer get(std::uint16_t port, const std::string& target, const std::string& headers) {
    const std::string host =
        headers.find("Host:") == std::string::npos ? fmt::format("Host: 127.0.0.1:{}\r\n", port) : "";
    return ask(port, fmt::format("GET {} HTTP/1.1\r\n{}{}\r\n", target, host, headers));
}

Viewer::Viewer(std::uint16_t port, const std::string& target) : socket_(loop_) {
    beast::get_lowest_layer(socket_).connect(at(port));
    const std::string host = fmt::format("127.0.0.1:{}", port);
    socket_.set_option(websocket::stream_base::decorator(
        [&host](websocket::request_type& request) { request.set(http::field::origin, "http://" + host); }));
    socket_.read_message_max(std::size_t{256} << 20U);
    socket_.handshake(host, target);
}

Viewer::~Viewer() {
    boost::system::error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
}

std::optional<Viewer::Heard> Viewer::next() {
    beast::flat_buffer buffer;
    boost::system::error_code error;
    socket_.read(buffer, error);
    if (error) return std::nullopt;
    return Heard{socket_.got_text(), beast::buffers_to_string(buffer.data())};
}

core::Json Viewer::words(const std::string& name) {
    while (const std::optional<Heard> heard = next()) {
        if (!heard->is_text) continue;
        const core::Json json = core::Json::parse(heard->bytes);
        if (json.contains(name)) return json.at(name);
    }
    throw std::runtime_error("the server closed the connection before it said " + name);
}

void Viewer::say(const std::string& words) {
    socket_.text(true);
    socket_.write(asio::buffer(words));
}

void Viewer::say_bytes(const std::string& bytes) {
    socket_.binary(true);
    socket_.write(asio::buffer(bytes));
}

}  // namespace clearway::server
