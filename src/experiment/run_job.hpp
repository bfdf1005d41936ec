#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiment/condition.hpp"
#include "experiment/simulation.hpp"

namespace clearway::experiment {

/// Whether every step of a run is kept in a file (trace/recording.hpp). It changes no result.
enum class StepRecording : std::uint8_t { off, on };
constexpr core::Spellings<StepRecording, 2> spellings(StepRecording) {
    return {{{StepRecording::off, "off"}, {StepRecording::on, "on"}}};
}

/// What a run may use before it is ended. A run over a limit has failed; the others of its job go on.
struct RunLimits {
    double wall_s = 3600.0;  ///< > 0, shared warm-up excluded. Assumed: far above any run met so far.
    long memory_mib = 0;     ///< Resident size of its process; 0: no limit. Looked at 20 times a second.

    bool operator==(const RunLimits&) const = default;
};

/// A run that is watched while it happens. It changes no result.
struct WindowSpec {
    double delay_s = 0.05;
    std::filesystem::path settings_file;  ///< Empty: Clearway's own.
    std::string program = "sumo-gui";     ///< Or `sumo`: the same without a window.

    static constexpr auto fields() {
        using Self = WindowSpec;
        return std::make_tuple(
            core::Field{"delay_s", "s", &Self::delay_s, 0, 10,
                        "Wall time that a step takes at least, from where conditions part",
                        "a step of 0.5 s passes ten times as fast as it happens"},
            core::Field{"settings_file", "", &Self::settings_file, 0, 0, "View settings of sumo-gui",
                        "Clearway's own"},
            core::Field{"program", "", &Self::program, 0, 0, "The SUMO that runs it", "sumo-gui"});
    }
    bool operator==(const WindowSpec&) const = default;
};

/// Runs: several conditions of one simulation and one traffic model, forked from one warm-up.
struct RunJob : Simulation {
    TrafficModel traffic_model = TrafficModel::standard;
    StepRecording recording = StepRecording::off;  ///< Of all conditions but those in free flow.
    std::vector<ConditionSpec> conditions;
    RunLimits limits;
    std::filesystem::path output;  ///< Run folder of the study: what `results::Store` opens.
    std::optional<WindowSpec> window = std::nullopt;  ///< Of a job of one condition.

    bool operator==(const RunJob&) const = default;
};

}  // namespace clearway::experiment
