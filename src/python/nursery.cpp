#include "python/nursery.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/process.hpp"
#include "python/interpreter.hpp"

namespace clearway::python {
namespace {

/// Name of the nursery's socket, without the byte 0 that begins it: a name of Linux that is no file.
constexpr const char* variable = "CLEARWAY_NURSERY";

struct Address {
    sockaddr_un place{};
    socklen_t length = sizeof(sa_family_t);
};

Address address_of(const std::string& name) {
    Address address;
    address.place.sun_family = AF_UNIX;
    const std::size_t letters = std::min(name.size(), sizeof(address.place.sun_path) - 1);
    std::memcpy(address.place.sun_path + 1, name.data(), letters);
    address.length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + letters);
    return address;
}

int new_socket() {
    return ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
}

/// A listener under a name that the system chooses, and that name.
std::pair<int, std::string> listener() {
    const int listener = new_socket();
    Address address;
    address.place.sun_family = AF_UNIX;
    auto* const place = reinterpret_cast<sockaddr*>(&address.place);
    socklen_t length = sizeof(address.place);
    if (listener < 0 || ::bind(listener, place, address.length) != 0 || ::listen(listener, SOMAXCONN) != 0 ||
        ::getsockname(listener, place, &length) != 0)
        throw core::EnvironmentError(fmt::format("cannot make a local socket: {}", std::strerror(errno)));
    return {listener, std::string(address.place.sun_path + 1, length - offsetof(sockaddr_un, sun_path) - 1)};
}

/// Sends a folder and descriptors.
bool send_to(int connection, const std::string& folder, const std::array<int, 4>& descriptors) {
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(descriptors))> control{};
    iovec text{const_cast<char*>(folder.data()), folder.size()};
    msghdr message{};
    message.msg_iov = &text;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(descriptors));
    std::memcpy(CMSG_DATA(header), descriptors.data(), sizeof(descriptors));
    return ::sendmsg(connection, &message, MSG_NOSIGNAL) == static_cast<ssize_t>(folder.size());
}

/// A connection to the nursery that has been asked for a part; -1 where there is none, or no more.
int ask_nursery(const Descriptors& theirs) {
    const char* const name = std::getenv(variable);
    if (name == nullptr) return -1;
    const Address address = address_of(name);
    const int connection = new_socket();
    if (connection < 0) return -1;
    const bool is_there =
        ::connect(connection, reinterpret_cast<const sockaddr*>(&address.place), address.length) == 0;
    const std::string folder = std::filesystem::current_path().string();
    if (is_there && send_to(connection, folder, {theirs.memory, theirs.read, theirs.write, STDERR_FILENO}))
        return connection;
    ::close(connection);
    return -1;
}

/// Starts Python, which inherits the descriptors: this process has one thread, so nothing else can.
std::unique_ptr<OwnedChild> own_process(const Descriptors& theirs) {
    for (const int descriptor : {theirs.memory, theirs.read, theirs.write})
        ::fcntl(descriptor, F_SETFD, 0);
    return std::make_unique<OwnedChild>(
        core::start(run_module("clearway._host", {std::to_string(theirs.memory), std::to_string(theirs.read),
                                                  std::to_string(theirs.write)}))
            .pid);
}

}  // namespace

OwnedChild::~OwnedChild() {
    if (pid_ < 0) return;
    ::kill(pid_, SIGTERM);
    const core::Child child{pid_, std::chrono::steady_clock::now()};
    constexpr int patience_ms = 1000;
    for (int waited_ms = 0; waited_ms < patience_ms; ++waited_ms) {
        if (core::poll(child)) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ::kill(pid_, SIGKILL);
    core::wait(child);
}

core::Exit OwnedChild::wait() {
    const core::Child child{std::exchange(pid_, -1), std::chrono::steady_clock::now()};
    return core::wait(child);
}

Nursery::Nursery() {
    const auto [socket, name] = listener();
    ::fcntl(socket, F_SETFD, 0);
    child_ = std::make_unique<OwnedChild>(
        core::start(run_module("clearway._nursery", {std::to_string(socket)})).pid);
    ::close(socket);  // so that nobody waits for a nursery that has ended
    ::setenv(variable, name.c_str(), 1);
}

Nursery::~Nursery() {
    ::unsetenv(variable);
}

Host::Host(const Descriptors& theirs)
    : connection_(ask_nursery(theirs)), child_(connection_ < 0 ? own_process(theirs) : nullptr) {}

Host::~Host() {
    if (connection_ < 0) return;
    constexpr int patience_ms = 3000;  // the nursery kills after one second
    ::shutdown(connection_, SHUT_WR);
    pollfd ended{connection_, POLLIN, 0};
    ::poll(&ended, 1, patience_ms);
    ::close(connection_);
}

std::optional<core::Exit> Host::wait() {
    if (child_) return child_->wait();
    int status = 0;
    ssize_t read = 0;
    while ((read = ::recv(connection_, &status, sizeof(status), 0)) < 0 && errno == EINTR) {
    }
    if (read != sizeof(status)) return std::nullopt;
    core::Exit exit;
    if (WIFSIGNALED(status)) exit.signal = WTERMSIG(status);
    if (WIFEXITED(status)) exit.code = WEXITSTATUS(status);
    return exit;
}

}  // namespace clearway::python
