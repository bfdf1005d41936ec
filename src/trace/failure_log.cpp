#include "trace/failure_log.hpp"

#include <fmt/format.h>

#include "core/random.hpp"
#include "failures/failure_config.hpp"
#include "metrics/true_links.hpp"
#include "sensing/sensor.hpp"
#include "trace/recording_tables.hpp"
#include "traffic/observation.hpp"

namespace clearway::trace {

struct FailureLogger::State {
    metrics::TrueLinks true_links;
    std::unique_ptr<sensing::SensorModel> sensor;
    traffic::Observation observation = {};
    sensing::FailureLog log = {};
};

FailureLogger::FailureLogger(const RecordingInfo& info, const std::string& failure,
                             const roads::Network& network) {
    const graph::LinkRules rules = loop_of(info).rules();
    const core::KeyedRandom random(core::StudySeed{info.provenance.study_seed},
                                   core::Replication{info.key.replication});
    state_ = std::make_unique<State>(State{
        metrics::TrueLinks(rules),
        sensing::make_sensor(failures::failure_from(failure), random, {.network = network, .rules = rules})});
}

FailureLogger::~FailureLogger() = default;

const sensing::FailureLog* FailureLogger::step(const RecordedStep& step) {
    const truth::Snapshot& snapshot = *step.snapshot;
    state_->sensor->observe(snapshot, *step.roster, state_->observation);
    if (!state_->observation.is_report) return nullptr;
    state_->true_links.look(snapshot);
    state_->sensor->log_failures(snapshot, state_->true_links.graph(), state_->log);
    return &state_->log;
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
