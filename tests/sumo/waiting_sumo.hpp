#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/process.hpp"

namespace clearway::test {

/// A TCP socket at a free port of this machine.
class Listener {
  public:
    Listener() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof(place);
        auto* const address = reinterpret_cast<sockaddr*>(&place);
        if (::bind(socket_, address, size) != 0 || ::listen(socket_, 1) != 0 ||
            ::getsockname(socket_, address, &size) != 0)
            throw std::runtime_error("no free port");
        port_ = ntohs(place.sin_port);
    }
    ~Listener() { ::close(socket_); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    int port() const { return port_; }
    /// Waits for one client, sends it `answer` as soon as it has said something, and hangs up.
    void answer_once(const std::string& answer) const {
        const int client = ::accept(socket_, nullptr, nullptr);
        char question = 0;
        (void)!::read(client, &question, 1);
        (void)!::write(client, answer.data(), answer.size());
        ::close(client);
    }

  private:
    int socket_;
    int port_ = 0;
};

/// A `sumo` of its own that was started with `--remote-port` and waits for its client. Ended with the object.
class WaitingSumo {
  public:
    WaitingSumo(std::vector<std::string> arguments, const std::filesystem::path& log)
        : port_(Listener().port()) {
        arguments.insert(arguments.end(), {"--remote-port", std::to_string(port_)});
        child_ = core::start({.program = "sumo",
                              .arguments = std::move(arguments),
                              .environment = {{"SUMO_HOME", "/usr/share/sumo"}},
                              .output = log});
        for (int tries = 0; tries < 600; ++tries) {
            if (listens()) return;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        throw std::runtime_error("SUMO does not start: " + core::tail(log, 5));
    }
    ~WaitingSumo() {
        kill();
        core::wait(child_);
    }
    WaitingSumo(const WaitingSumo&) = delete;
    WaitingSumo& operator=(const WaitingSumo&) = delete;

    int port() const { return port_; }
    void kill() const { ::kill(child_.pid, SIGKILL); }

  private:
    /// As the system's own table has it: SUMO would take a trial for its client.
    bool listens() const {
        const std::string place = fmt::format(":{:04X} 00000000:0000 0A", port_);
        return core::read_file("/proc/net/tcp").find(place) != std::string::npos;
    }

    int port_;
    core::Child child_;
};

}  // namespace clearway::test
