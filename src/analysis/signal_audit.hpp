#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/spellings.hpp"
#include "metrics/signal_event.hpp"

namespace clearway::analysis {

/// Least times that a signal must show its links, by link; none where none is required (roads::ProgramTimes).
struct SignalLimits {
    std::vector<std::optional<double>> yellow_s;
    std::vector<std::optional<double>> red_s;
    std::vector<std::optional<double>> green_s;
    std::vector<std::vector<bool>> foes;  ///< foes[a][b]: links a and b conflict.
};

enum class Shortfall : std::uint8_t { yellow, red_clearance, green };
constexpr core::Spellings<Shortfall, 3> spellings(Shortfall) {
    return {{{Shortfall::yellow, "yellow"},
             {Shortfall::red_clearance, "red clearance"},
             {Shortfall::green, "green"}}};
}

/// Something that was shorter than the signal's own program allows.
struct SignalFinding {
    std::string signal;
    std::uint16_t link = 0;
    Shortfall what = Shortfall::yellow;
    double ended_s = 0.0;  ///< Simulation time of its end.
    double lasted_s = 0.0;
    double least_s = 0.0;
};

struct SignalAudit {
    std::uint64_t yellows = 0;  ///< Checked.
    std::uint64_t reds = 0;
    std::uint64_t greens = 0;
    std::vector<SignalFinding> findings;  ///< In the order of their ends.
};

/// Checks every colour in an event log whose beginning and end the log holds. A link whose beginnings it does
/// not hold, and times that the program does not state, are not checked. A link needs no clearance
/// before pedestrians with whom it is green later on, because it yields to them. Times are compared in whole
/// steps of the simulation, because a program's own times are shown in whole steps too. Throws
/// core::InputError for a signal that `limits` lacks and for a link beyond its last one.
SignalAudit audit_signals(std::span<const metrics::SignalEvent> events,
                          const std::map<std::string, SignalLimits>& limits, double step_s);

}  // namespace clearway::analysis
