#pragma once

#include <array>
#include <csignal>

#include "core/error.hpp"

namespace clearway::core {

/// While this object lives, SIGINT and SIGTERM are noted instead of ending the process, so that children can
/// end first and files are closed. Only one may exist at a time, because signal handlers belong to the whole
/// process.
class InterruptionWatch {
  public:
    InterruptionWatch();
    ~InterruptionWatch();
    InterruptionWatch(const InterruptionWatch&) = delete;
    InterruptionWatch& operator=(const InterruptionWatch&) = delete;

    /// The first signal received since construction, or 0.
    int signal() const;
    /// `interrupted` or `terminated` after such a signal, otherwise `code`.
    ExitCode exit_code(ExitCode code) const;

  private:
    std::array<struct sigaction, 2> before_{};
};

}  // namespace clearway::core
