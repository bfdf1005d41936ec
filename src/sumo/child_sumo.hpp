#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/process.hpp"
#include "core/units.hpp"
#include "sumo/session.hpp"

namespace clearway::sumo {

/// A SUMO in a child process that waits for a client at a free port of this machine: `sumo-gui` with a
/// window, `sumo` without one. It ends with the object, and with this process.
class ChildSumo {
  public:
    /// Starts `program` with the arguments of a session and `more_arguments`. Both its streams go to `log`.
    ChildSumo(const std::string& program, const SessionConfig& config,
              const std::vector<std::string>& more_arguments, const std::filesystem::path& log);
    ~ChildSumo();
    ChildSumo(const ChildSumo&) = delete;
    ChildSumo& operator=(const ChildSumo&) = delete;

    /// Connects once the simulation is loaded. Throws core::EnvironmentError, with the end of the log, when
    /// the program is missing, has no display, or ends for another reason; also when it has another version.
    RemoteSumo connect();
    /// How it ended; nothing if it still runs after `patience`.
    std::optional<core::Exit> wait_for_end(core::Seconds patience);
    /// The end of its log.
    std::string last_words() const;

  private:
    std::string program_;
    std::filesystem::path log_;
    int port_;
    core::Child child_;
    std::optional<core::Exit> end_;
};

}  // namespace clearway::sumo
