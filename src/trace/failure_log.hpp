#pragma once

#include <memory>
#include <string>

#include "metrics/true_links.hpp"
#include "roads/network.hpp"
#include "sensing/sensor.hpp"
#include "trace/recording.hpp"
#include "traffic/observation.hpp"

namespace clearway::trace {

/// What sensors lacked in recorded traffic, with the draws of the recorded run. One thread.
class FailureLogger {
  public:
    /// `failure` may be another than the recorded one. `network` outlives the logger. Throws core::InputError
    /// for a failure that does not exist.
    FailureLogger(const RecordingInfo& info, const std::string& failure, const roads::Network& network);

    /// Takes every step in the order of the recording. The log where a report round took place, valid until
    /// the next call; otherwise null.
    const sensing::FailureLog* step(const RecordedStep& step);

  private:
    std::unique_ptr<sensing::SensorModel> sensor_;
    traffic::Observation observation_;
    metrics::TrueLinks true_links_;
    sensing::FailureLog log_;
};

/// Header and lines of a log as CSV: `time_s,what,vehicle,other_vehicle,cause`, a line for each vehicle that
/// is `dark` or `never_seen` and for each `lost_link`, whose cause is one of these two.
inline constexpr const char* failure_log_header = "time_s,what,vehicle,other_vehicle,cause\n";
std::string csv_lines(const sensing::FailureLog& log, const traffic::Roster& roster);

}  // namespace clearway::trace
