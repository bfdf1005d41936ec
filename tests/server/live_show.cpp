#include "server/live_show.hpp"

#include <cstring>
#include <stdexcept>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "view/frame_encoder.hpp"

namespace clearway::server {

FakeRun::FakeRun(const std::filesystem::path& socket, const std::string& condition)
    : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, socket.c_str(), sizeof address.sun_path - 1);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        throw std::runtime_error("no server at " + socket.string());
    std::string greeting;
    view::FrameEncoder::encode_message(R"({"condition": ")" + condition + "\"}", greeting);
    view::FrameEncoder::encode_message("{}", greeting);
    send(greeting);
}

void FakeRun::close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
}

void FakeRun::send(const std::string& bytes) const {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
        const ssize_t now = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (now <= 0) throw std::runtime_error("the server has gone");
        sent += static_cast<std::size_t>(now);
    }
}

void FakeRun::frame(int kind, double time_s, std::size_t bytes) const {
    std::string content;
    auto left = static_cast<std::uint64_t>(time_s * 1000.0 + 0.5);
    for (; left >= 128; left /= 128)
        content.push_back(static_cast<char>(left % 128 + 128));
    content.push_back(static_cast<char>(left));
    content.append(bytes, 'x');
    std::string block;
    view::FrameEncoder::append_block(static_cast<view::BlockKind>(kind), content, block);
    send(block);
}

bool FakeRun::is_told_within(int milliseconds) const {
    pollfd wait{.fd = socket_, .events = POLLIN, .revents = 0};
    return ::poll(&wait, 1, milliseconds) == 1;
}

double FakeRun::allowed() const {
    double allowed_s = 0.0;
    if (::recv(socket_, &allowed_s, sizeof allowed_s, MSG_WAITALL) != sizeof allowed_s)
        throw std::runtime_error("the server has gone");
    return allowed_s;
}

LiveShow::LiveShow(LiveConfig config) {
    config.port = 0;
    server_ = std::make_unique<LiveServer>(config, folder_.path());
    thread_ = std::thread([this] {
        server_->run([this] { return stop_.load(); });
        has_ended_ = true;
    });
}

LiveShow::~LiveShow() {
    counts();
}

FakeRun LiveShow::run(std::size_t number, const std::string& condition) const {
    return {socket_of(folder_.path(), number), condition};
}

bool LiveShow::ends() const {
    for (int tries = 0; tries < 1000 && !has_ended_; ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return has_ended_;
}

LiveCounts LiveShow::counts() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return server_->counts();
}

}  // namespace clearway::server
