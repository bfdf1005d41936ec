#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/supervisor.hpp"

namespace clearway::core {

/// The option with which a program is asked to serve; then follow its descriptor and the client's process.
inline constexpr const char* serve_option = "--serve";

/// Forks a child of `client` for each request that comes over `channel`, which calls `work` with its word and
/// ends with what that returns. Returns when the other end is closed. For a process of one thread.
void serve_forks(int channel, pid_t client, const std::function<int(const std::string& word)>& work);

/// Starts a program once, with `serve_option`, and has it fork for each command of one word: what the program
/// loads is loaded once. Such a child is a child of this process, with all that core::start promises. Other
/// commands are started by `machine`, and so are all where the server fails.
class ForkServer : public Machine {
  public:
    explicit ForkServer(std::filesystem::path program, Machine& machine = this_machine());
    ~ForkServer() override { end_server(); }

    Clock::time_point now() override { return machine_.now(); }
    void pause() override { machine_.pause(); }
    Child start(const Command& command) override;
    std::optional<Exit> poll(const Child& child) override { return machine_.poll(child); }
    std::optional<long> resident_kib(const Child& child) override { return machine_.resident_kib(child); }
    void kill(const Child& child, int signal) override { machine_.kill(child, signal); }

  private:
    void start_server();
    void end_server();

    std::filesystem::path program_;
    Machine& machine_;
    bool is_tried_ = false;
    int channel_ = -1;  ///< To the server; -1 without one.
    Child server_;
};

}  // namespace clearway::core
