#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace clearway::python {

/// Code of the user has failed, or its process has ended. `what()` holds the traceback.
class PartError : public core::Error {
  public:
    explicit PartError(const std::string& message) : core::Error(core::ExitCode::runs_failed, message) {}
};

/// The machine failed a part, not its code: its process was killed, or it got no memory, file or descriptor.
/// Another attempt may succeed.
class PartLost : public core::Error {
  public:
    /// `signal` killed its process; 0: its code told the failure.
    PartLost(const std::string& message, int signal)
        : core::Error(core::ExitCode::runs_failed, message), signal_(signal) {}
    int signal() const { return signal_; }

  private:
    int signal_;
};

/// The bells of the protocol: one byte on a pipe hands the shared memory over. A pipe is a bell that also
/// tells when the other process is gone, however it ended, so that nobody waits for ever. Decision 7 has the
/// measurements.
enum class Bell : char {
    hello = 'H',   ///< To Python: what the part may know for the whole run stands in the memory, as JSON.
    decide = 'D',  ///< To Python: a sheet to answer.
    answer = 'A',  ///< From Python: the answer stands in the memory.
    failed = 'F',  ///< From Python: a traceback stands in the memory, as text.
    lost = 'L',    ///< From Python: the same, and the machine failed, not the code.
    reset = 'R',   ///< From an environment: begin an episode.
    ended = 'E',   ///< To an environment: the run is over.
};

/// Three descriptors that a process gets from the one that started it, or makes for the one that it starts.
struct Descriptors {
    int memory = -1;
    int read = -1;
    int write = -1;
};

/// Memory that is shared with a Python process, and the two pipes. The first half is written by this side,
/// the other half by Python. Moves are not needed; one thread.
class Channel {
  public:
    /// Bytes in each direction, taken from the machine only as they are used: a belief of 100,000 vehicles
    /// takes 25 MB.
    static constexpr std::size_t capacity = std::size_t{1} << 26;

    /// Makes memory and pipes; `theirs` are to be given to the Python process, then `close_theirs`. Throws
    /// core::EnvironmentError.
    Channel();
    /// Joins what another process made; takes the descriptors over.
    explicit Channel(const Descriptors& ours);
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    const Descriptors& theirs() const { return theirs_; }
    void close_theirs();

    std::span<std::byte> outgoing() const { return {memory_, capacity}; }
    std::span<std::byte> incoming() const { return {memory_ + capacity, capacity}; }
    /// A text at the front of the outgoing memory: its length (u64), then its bytes.
    void write_text(std::string_view text) const;
    std::string read_text() const;

    /// Returns whether the other side can still hear it.
    bool ring(Bell bell) const;
    /// Waits for the other side's bell; false when it has gone.
    bool wait(Bell& bell) const;

  private:
    void map();

    Descriptors ours_, theirs_;
    std::byte* memory_ = nullptr;
};

}  // namespace clearway::python
