#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "core/spellings.hpp"
#include "experiment/condition.hpp"
#include "experiment/run_key.hpp"
#include "metrics/run_metrics.hpp"

namespace clearway::results {

/// Which vehicles of a run are read.
enum class VehicleRows : std::uint8_t {
    all,
    emergency,  ///< The others are most of a run; a report needs only their metrics.
};

/// A completed run. A function of scenario, condition, seed and versions alone: no clock time, no machine.
struct RunRecord {
    experiment::RunKey key;
    experiment::ConditionSpec condition;
    experiment::Provenance provenance;
    metrics::RunMetrics metrics;
    std::vector<metrics::VehicleRow> vehicles;
    /// Where time was lost; empty for solo. Journeys, edge times, holds and locks are
    /// written but not read back; see Store::read_traffic.
    metrics::TrafficTables traffic;
    std::vector<metrics::LeaseRow> leases = {};  ///< By policy, then action.
    /// Written but not read back; see Store::read_signal_events. Nothing where no policy could ask for
    /// greens.
    std::optional<std::vector<metrics::SignalEvent>> signal_events = {};
    std::string build = {};  ///< Of the programs. Written from the manifest.

    bool operator==(const RunRecord&) const = default;
};

/// Wall time of the parts of the loop beside SUMO's steps, s.
struct PhaseTimes {
    double reading_s = 0.0;     ///< SUMO's state.
    double sensing_s = 0.0;     ///< What sensors observe.
    double prediction_s = 0.0;  ///< The believed graph.
    double policy_s = 0.0;      ///< Messages to signals, and leases.
    double actuation_s = 0.0;   ///< Requests, commands, and drivers.
    double recording_s = 0.0;   ///< Measures, incidents, and whoever listens.

    double sum_s() const {
        return reading_s + sensing_s + prediction_s + policy_s + actuation_s + recording_s;
    }
};

/// What a run cost. Kept apart from the record because it differs from machine to machine.
struct RunTiming {
    double wall_s = 0.0;
    double simulator_s = 0.0;  ///< SUMO's own step.
    double coupling_s = 0.0;   ///< Everything else in the loop.
    long peak_kib = 0;
    std::string made_at;  ///< UTC, set when it is written.
    // From here on written but not read back.
    double processor_s = 0.0;  ///< Of the process.
    PhaseTimes phases;         ///< Of `coupling_s`.
    std::uint64_t steps = 0;
    std::uint64_t vehicle_steps = 0;  ///< Vehicles on the road, summed over these steps.

    static constexpr void fields(const auto& table) {
        using T = RunTiming;
        using core::Field;
        table(Field{"wall_s", "s", &T::wall_s, 0.0, 1e9, "Wall time of the run, shared warm-up excluded", ""},
              Field{"simulator_s", "s", &T::simulator_s, 0.0, 1e9, "Of it, SUMO's own steps", ""},
              Field{"coupling_s", "s", &T::coupling_s, 0.0, 1e9, "Of it, everything else in the loop", ""},
              Field{"peak_kib", "KiB", &T::peak_kib, 0.0, 1e12, "Largest resident size of the process", ""});
    }
};

/// Why a run has no record.
enum class ErrorCause : std::uint8_t {
    simulator,   ///< SUMO reported an error.
    signal,      ///< The process was killed, usually by an assertion or a bad access inside SUMO.
    time_limit,  ///< It exceeded the wall time limit.
    memory,      ///< It exceeded the memory limit.
    bad_input,   ///< The scenario is invalid.
    python,      ///< A part that is the user's Python code failed.
    machine,     ///< It got no memory, file or descriptor.
    other,
};
constexpr core::Spellings<ErrorCause, 8> spellings(ErrorCause) {
    return {{{ErrorCause::simulator, "simulator"},
             {ErrorCause::signal, "signal"},
             {ErrorCause::time_limit, "time_limit"},
             {ErrorCause::memory, "memory"},
             {ErrorCause::bad_input, "bad_input"},
             {ErrorCause::python, "python"},
             {ErrorCause::machine, "machine"},
             {ErrorCause::other, "other"}}};
}
using core::name;
/// Whether another attempt could end differently at once: signals and time limits.
constexpr bool worth_retrying(ErrorCause cause) {
    return cause == ErrorCause::signal || cause == ErrorCause::time_limit;
}
/// Whether the machine ended the run, not its input, so that it may succeed when its study is continued.
constexpr bool may_pass(ErrorCause cause) {
    return worth_retrying(cause) || cause == ErrorCause::memory || cause == ErrorCause::machine;
}

/// A run that ended without a record.
struct RunError {
    experiment::RunKey key;
    ErrorCause cause = ErrorCause::other;
    std::string message;
    int exit_code = 0;
    int signal = 0;
    int attempts = 1;
    std::string log_tail;  ///< Last lines of SUMO's log and of the worker's.
    std::string command;   ///< Shell command that repeats the run.

    bool operator==(const RunError&) const = default;
};

}  // namespace clearway::results
