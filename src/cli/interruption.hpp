#pragma once

#include <csignal>

namespace clearway::cli {

/// While an object of this class lives, SIGINT and SIGTERM do not end the program but are remembered. One at
/// a time; main thread.
class InterruptionWatch {
  public:
    InterruptionWatch();
    ~InterruptionWatch();
    InterruptionWatch(const InterruptionWatch&) = delete;
    InterruptionWatch& operator=(const InterruptionWatch&) = delete;

    /// The last signal since construction, or 0.
    int received() const;

  private:
    struct sigaction earlier_interrupt_ = {};
    struct sigaction earlier_terminate_ = {};
};

}  // namespace clearway::cli
