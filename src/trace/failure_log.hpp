#pragma once

#include <memory>
#include <string>

#include "roads/network.hpp"
#include "trace/recording.hpp"

namespace clearway::sensing {
struct FailureLog;
}

namespace clearway::trace {

/// Logs what sensors missed in recorded traffic, with the random draws of the recorded run. One thread.
class FailureLogger {
  public:
    /// `failure` may differ from the recorded one. `network` outlives the logger. Throws core::InputError for
    /// an unknown failure.
    FailureLogger(const RecordingInfo& info, const std::string& failure, const roads::Network& network);
    ~FailureLogger();
    FailureLogger(const FailureLogger&) = delete;
    FailureLogger& operator=(const FailureLogger&) = delete;

    /// Takes every step in the order of the recording. Returns the log of a report round, valid until the
    /// next call; null when the step has none.
    const sensing::FailureLog* step(const RecordedStep& step);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Header and lines of a log as CSV: `time_s,what,vehicle,other_vehicle,cause`, one line per vehicle that is
/// `dark` or `never_seen` and per `lost_link`, whose cause is one of these two.
inline constexpr const char* failure_log_header = "time_s,what,vehicle,other_vehicle,cause\n";
std::string csv_lines(const sensing::FailureLog& log, const traffic::Roster& roster);

}  // namespace clearway::trace
