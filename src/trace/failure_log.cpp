#include "trace/failure_log.hpp"

#include <fmt/format.h>

#include "core/random.hpp"
#include "sensing/failure_config.hpp"
#include "trace/recording_tables.hpp"

namespace clearway::trace {

FailureLogger::FailureLogger(const RecordingInfo& info, const std::string& failure,
                             const roads::Network& network)
    : true_links_(loop_of(info).rules()) {
    const core::KeyedRandom random(core::StudySeed{info.provenance.study_seed},
                                   core::Replication{info.key.replication});
    sensor_ = sensing::make_sensor(sensing::failure_from(failure), random,
                                   {.network = network, .rules = true_links_.rules()});
}

const sensing::FailureLog* FailureLogger::step(const RecordedStep& step) {
    const truth::Snapshot& snapshot = *step.snapshot;
    sensor_->observe(snapshot, *step.roster, observation_);
    if (!observation_.is_report) return nullptr;
    true_links_.look(snapshot);
    sensor_->log_failures(snapshot, true_links_.graph(), log_);
    return &log_;
}

std::string csv_lines(const sensing::FailureLog& log, const traffic::Roster& roster) {
    const auto vehicle = [&](core::VehicleKey key) { return vehicle_cell(roster, key); };
    std::string text;
    for (const core::VehicleKey key : log.dark)
        text += fmt::format("{},dark,{},,\n", log.time.value, vehicle(key));
    for (const core::VehicleKey key : log.never_seen)
        text += fmt::format("{},never_seen,{},,\n", log.time.value, vehicle(key));
    for (const sensing::FailureLog::LostLink& link : log.lost_links) {
        const bool is_dark = link.cause == sensing::FailureLog::Cause::dark;
        text += fmt::format("{},lost_link,{},{},{}\n", log.time.value, vehicle(link.left),
                            vehicle(link.right), is_dark ? "dark" : "never_seen");
    }
    return text;
}

}  // namespace clearway::trace
