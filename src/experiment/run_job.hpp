#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment/condition.hpp"
#include "experiment/simulation.hpp"

namespace clearway::experiment {

/// Whether every step of a run is recorded in a file (trace/recording.hpp). Does not change results.
enum class StepRecording : std::uint8_t { off, on };
constexpr core::Spellings<StepRecording, 2> spellings(StepRecording) {
    return {{{StepRecording::off, "off"}, {StepRecording::on, "on"}}};
}

/// What a run may use before it is killed. A run over a limit has an error; the others of its job continue.
struct RunLimits {
    double wall_s = 3600.0;  ///< > 0, shared warm-up excluded. Assumed: far above any run seen so far.
    long memory_mib = 0;     ///< Resident size of its process; 0: no limit. Checked 20 times per second.

    bool operator==(const RunLimits&) const = default;
};

/// How a run is shown while it happens. Does not change results.
struct WindowSpec {
    double delay_s = 0.05;
    std::filesystem::path settings_file;  ///< Empty: Clearway's own.
    std::string program = "sumo-gui";     ///< Or `sumo`: the same without a window.

    static constexpr void fields(const auto& table) {
        using Self = WindowSpec;
        table(core::Field{"delay_s", "s", &Self::delay_s, 0, 10,
                          "Minimum wall time of a step, once conditions have forked",
                          "a step of 0.5 s runs ten times faster than real time"},
              core::Field{"settings_file", "", &Self::settings_file, 0, 0, "View settings of sumo-gui",
                          "Clearway's own"},
              core::Field{"program", "", &Self::program, 0, 0, "The SUMO program that runs it", "sumo-gui"});
    }
    bool operator==(const WindowSpec&) const = default;
};

/// A run that is watched while it happens, through a server that decides how far it may go. Does not change
/// results.
struct LiveSpec {
    std::filesystem::path socket;  ///< Where the server listens (view/run_stream.hpp, server/feed.hpp).

    static constexpr void fields(const auto& table) {
        using Self = LiveSpec;
        table(core::Field{"socket", "", &Self::socket, 0, 0, "Local socket of the server that shows the run",
                          "given"});
    }
    bool operator==(const LiveSpec&) const = default;
};

/// Several conditions of one simulation and traffic model, forked from one warm-up.
struct RunJob : Simulation {
    TrafficModel traffic_model = TrafficModel::standard;
    StepRecording recording = StepRecording::off;  ///< Applies to all conditions except free flow.
    std::vector<ConditionSpec> conditions;
    RunLimits limits;
    std::filesystem::path output;  ///< Run folder of the study: what `results::Store` opens.
    std::optional<WindowSpec> window = std::nullopt;  ///< Only for a job with one condition.
    std::optional<LiveSpec> live = std::nullopt;      ///< Likewise; not together with a window.

    bool operator==(const RunJob&) const = default;
};

}  // namespace clearway::experiment
