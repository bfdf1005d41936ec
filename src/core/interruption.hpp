#pragma once

#include <array>
#include <csignal>
#include <string>

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

/// While this object lives and no InterruptionWatch does, SIGINT and SIGTERM end the process as they do
/// otherwise, but after a text on standard error. For one thread; only one may exist at a time.
class InterruptionNotice {
  public:
    explicit InterruptionNotice(const std::string& text);
    ~InterruptionNotice();
    InterruptionNotice(const InterruptionNotice&) = delete;
    InterruptionNotice& operator=(const InterruptionNotice&) = delete;
};

}  // namespace clearway::core
