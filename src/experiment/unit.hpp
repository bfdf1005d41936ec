#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/settings.hpp"
#include "traffic/command.hpp"
#include "traffic/departure.hpp"

namespace clearway::experiment {

/// SUMO options that a whole process shares; conditions of one process differ in everything else.
enum class Engine : std::uint8_t {
    standard,
    sublane,  ///< --lateral-resolution.
    solo,     ///< Each emergency vehicle alone on the road with every signal open.
};

/// `standard`, `sublane`, `solo`.
std::string_view name(Engine engine);
std::optional<Engine> engine_from(std::string_view word);

/// `on`, `off`.
std::string_view name(traffic::SafetyChecks checks);
/// One of an enumeration of these two.
template <class Switch>
std::optional<Switch> switch_from(std::string_view word) {
    if (word == "on") return Switch::on;
    if (word == "off") return Switch::off;
    return std::nullopt;
}

/// Whether every step of a run is kept in a file (results/recording.hpp). It changes no result.
enum class StepRecording : std::uint8_t { off, on };

/// A named combination of failure, predictor and policy parts.
struct ConditionSpec {
    std::string name;
    std::string failure = "perfect";  ///< As sensing::failure_from reads it: perfect, B10, ...
    std::string predictor = "none";
    std::vector<std::string> parts;  ///< Policy parts; empty: the car-following model alone.
    Engine engine = Engine::standard;
    traffic::SafetyChecks safety_checks = traffic::SafetyChecks::on;
    core::Settings loop_settings = {};  ///< Members of LoopConfig that differ from its defaults.
    traffic::BlueLight bluelight = traffic::BlueLight::off;  ///< SUMO's own model of a rescue lane.

    /// Factors of the study that made it, `failure.dark_share` -> `0.3`; they say what the rest already
    /// holds.
    core::Settings factors = {};

    /// Whether anything is done for emergency vehicles; a condition where nothing is can be a baseline.
    bool acts() const { return !parts.empty() || bluelight == traffic::BlueLight::on; }

    bool operator==(const ConditionSpec&) const = default;
};

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
