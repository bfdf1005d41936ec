#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment/condition.hpp"

namespace clearway::experiment {

/// Whether every step of a run is kept in a file (results/recording.hpp). It changes no result.
enum class StepRecording : std::uint8_t { off, on };

/// What a run may use before it is ended. A run over a limit has failed; the others of its unit go on.
struct RunLimits {
    double wall_s = 3600.0;  ///< > 0, shared warm-up excluded. Assumed: far above any run met so far.
    long memory_mib = 0;     ///< Resident size of its process; 0: no limit. Looked at 20 times a second.

    bool operator==(const RunLimits&) const = default;
};

/// A run that is watched while it happens. It changes no result.
struct WindowSpec {
    double delay_s = 0.05;  ///< Wall time that a step takes at least, from where conditions part.
    std::filesystem::path settings_file;  ///< sumo-gui's view settings; empty: Clearway's own.
    std::string program = "sumo-gui";     ///< Or `sumo`: the same without a window.

    bool operator==(const WindowSpec&) const = default;
};

/// What one worker process does: one scenario, one replication, one engine, several conditions forked from
/// one warm-up.
struct UnitSpec {
    std::string scenario;                  ///< Name of the scenario.
    std::filesystem::path scenario_file;   ///< The effective configuration, TOML.
    std::filesystem::path network_folder;  ///< Network built once for the study.
    std::uint64_t study_seed = 1;
    std::uint32_t replication = 0;
    Engine engine = Engine::standard;
    StepRecording recording = StepRecording::off;  ///< Of all conditions but those of engine `solo`.
    std::vector<ConditionSpec> conditions;
    RunLimits limits;
    std::filesystem::path output;  ///< Run folder of the study: what `results::Store` opens.
    std::optional<WindowSpec> window = std::nullopt;  ///< Of a unit of one condition.

    bool operator==(const UnitSpec&) const = default;
};

/// JSON, for the worker's command line. `read_unit` throws core::InputError with every problem.
std::string to_json(const UnitSpec& unit);
UnitSpec read_unit(const std::filesystem::path& file);

}  // namespace clearway::experiment
