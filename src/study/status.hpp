#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/store.hpp"

namespace clearway::study {

enum class State : std::uint8_t {
    running,   ///< A process works in the folder.
    stopped,   ///< No process does, and runs are missing: interrupted, killed, or not begun.
    complete,  ///< Every run is complete.
    failed,    ///< Every run has ended, some without a result.
};
/// `running`, `stopped`, ...
std::string_view name(State state);

/// A condition in a scenario.
struct CellStatus {
    std::string scenario;
    std::string condition;
    traffic::SafetyChecks safety_checks = traffic::SafetyChecks::on;
    std::size_t runs = 0;
    std::size_t complete = 0;
    std::size_t failed = 0;
};

/// Progress of the study in a run folder, seen from outside.
struct StudyStatus {
    std::filesystem::path folder;
    State state = State::stopped;
    std::string holder;  ///< `process 4711 on host` while it runs.
    std::vector<CellStatus> cells;
    std::size_t runs = 0;
    std::size_t complete = 0;
    std::size_t failed = 0;
    /// Remaining time at the pace since the running process began, by what the runs of each cell take; empty
    /// before its first run ends.
    std::optional<double> time_left_s;
};

/// Reads a run folder, whether or not a process works in it, without disturbing that. Takes about as long as
/// listing its folders. Throws core::InputError when it is not a run folder.
StudyStatus read_status(const std::filesystem::path& folder);

}  // namespace clearway::study
