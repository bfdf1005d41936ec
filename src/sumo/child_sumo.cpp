#include "sumo/child_sumo.hpp"

#include <chrono>
#include <csignal>
#include <thread>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "sumo/detail/options.hpp"

namespace clearway::sumo {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int shown_log_lines = 8;
constexpr int not_started = 127;  // as in core::Exit
/// A large city takes minutes to load, and SUMO opens its window before the first answer.
constexpr core::Seconds loading_patience{600.0};
constexpr core::Seconds answer_patience{120.0};
constexpr core::Seconds ending_patience{5.0};

/// A port of this machine that is free at this moment.
int free_port() {
    const int probe = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(place);
    auto* const address = reinterpret_cast<sockaddr*>(&place);
    const bool found = ::bind(probe, address, size) == 0 && ::getsockname(probe, address, &size) == 0;
    ::close(probe);
    if (!found) throw core::EnvironmentError("no port of this machine is free for SUMO");
    return ntohs(place.sin_port);
}

/// Reads the system's table, because SUMO would take a test connection for its client.
bool is_listened_to(int port) {
    return core::read_file("/proc/net/tcp").find(fmt::format(":{:04X} 00000000:0000 0A", port)) !=
           std::string::npos;
}

core::Child start(const std::string& program, const SessionConfig& config,
                  const std::vector<std::string>& more_arguments, int port,
                  const std::filesystem::path& log) {
    detail::set_sumo_home();
    std::vector<std::string> arguments = command_line(config);
    arguments.insert(arguments.end(), {"--remote-port", std::to_string(port)});
    arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
    return core::start({.program = program, .arguments = std::move(arguments), .output = log});
}

}  // namespace

ChildSumo::ChildSumo(const std::string& program, const SessionConfig& config,
                     const std::vector<std::string>& more_arguments, const std::filesystem::path& log)
    : program_(program),
      log_(log),
      port_(free_port()),
      child_(start(program, config, more_arguments, port_, log)) {}

ChildSumo::~ChildSumo() {
    try {
        if (wait_for_end(core::Seconds(0.0))) return;
        ::kill(child_.pid, SIGTERM);
        if (wait_for_end(ending_patience)) return;
        ::kill(child_.pid, SIGKILL);
        core::wait(child_);
    } catch (const std::exception&) {
        // It has ended, and a destructor cannot report errors.
    }
}

RemoteSumo ChildSumo::connect() {
    constexpr core::Seconds pause{0.05};
    const auto until = Clock::now() + std::chrono::duration<double>(loading_patience.value);
    while (!is_listened_to(port_)) {
        if (const auto end = wait_for_end(pause)) {
            if (end->code == not_started)
                throw core::EnvironmentError(
                    fmt::format("{} is not installed (Debian package sumo), or not in PATH", program_));
            throw core::EnvironmentError(
                fmt::format("{} does not start: {}\n{}", program_, end->describe(), last_words()));
        }
        if (Clock::now() > until)
            throw core::EnvironmentError(fmt::format("{} has not loaded its simulation within {} s", program_,
                                                     loading_patience.value));
    }
    return {"localhost", port_, answer_patience};
}

std::optional<core::Exit> ChildSumo::wait_for_end(core::Seconds patience) {
    constexpr auto pause = std::chrono::milliseconds(10);
    const auto until = Clock::now() + std::chrono::duration<double>(patience.value);
    while (!end_) {
        end_ = core::poll(child_);
        if (end_ || Clock::now() >= until) break;
        std::this_thread::sleep_for(pause);
    }
    return end_;
}

std::string ChildSumo::last_words() const {
    return core::tail(log_, shown_log_lines);
}

}  // namespace clearway::sumo
