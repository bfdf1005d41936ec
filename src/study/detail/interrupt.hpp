#pragma once

#include <array>
#include <csignal>

namespace clearway::study::detail {

/// While this object lives, SIGINT and SIGTERM are noted instead of ending the process. One at a time.
class InterruptWatch {
  public:
    InterruptWatch();
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    /// The first signal that came, or 0.
    int signal() const;

  private:
    std::array<struct sigaction, 2> before_{};
};

}  // namespace clearway::study::detail
