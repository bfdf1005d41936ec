#pragma once

#include <memory>
#include <optional>

#include <sys/types.h>

#include "core/process.hpp"
#include "python/channel.hpp"

namespace clearway::python {

/// A child process that ends with its owner: SIGTERM, a second of patience, SIGKILL.
class OwnedChild {
  public:
    explicit OwnedChild(pid_t pid = -1) : pid_(pid) {}
    ~OwnedChild();
    OwnedChild(const OwnedChild&) = delete;
    OwnedChild& operator=(const OwnedChild&) = delete;
    /// Waits for its end and says how it ended.
    core::Exit wait();

  private:
    pid_t pid_;
};

/// While it lives, parts of this process and of those that it starts are copies of one Python process that
/// has loaded numpy and the package (python/clearway/_nursery.py): a part takes some milliseconds of
/// processor time instead of the tenth of a second that an interpreter needs. One at a time in a process;
/// sets an environment variable, so no other thread may run while it is made or destroyed.
class Nursery {
  public:
    /// Does not wait until Python is there. Throws core::EnvironmentError when it cannot be started.
    Nursery();
    ~Nursery();
    Nursery(const Nursery&) = delete;
    Nursery& operator=(const Nursery&) = delete;

  private:
    std::unique_ptr<OwnedChild> child_;
};

/// The process of one part: a copy of the nursery, or, where there is none, a Python process of its own. It
/// ends with its owner, however that ends.
class Host {
  public:
    /// Throws core::EnvironmentError when it cannot be started.
    explicit Host(const Descriptors& theirs);
    ~Host();
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;
    /// Waits for its end and says how it ended; nothing where the nursery was killed, and it with the
    /// nursery.
    std::optional<core::Exit> wait();

  private:
    int connection_;  ///< To the nursery; -1 without one.
    std::unique_ptr<OwnedChild> child_;
};

}  // namespace clearway::python
