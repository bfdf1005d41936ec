#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/fields.hpp"

namespace clearway::metrics {

/// Codes that signal controllers write into their high-resolution event logs: Indiana Traffic Signal Hi
/// Resolution Data Logger Enumerations (Sturdevant et al., Purdue University and INDOT, November 2012), which
/// ATSPM systems read. Gates (103) and track clearance (106) do not exist at these signals and are never
/// written.
enum class SignalCode : std::uint32_t {
    begin_green = 1,
    begin_yellow = 8,
    begin_red_clearance = 10,
    end_red_clearance = 11,  ///< A link that conflicts opens, or the same one again.
    begin_walk = 21,
    begin_dont_walk = 23,
    detector_on = 82,  ///< Parameter: pre-empt; an emergency vehicle passes the stop line.
    call_on = 102,
    call_off = 104,
    entry_started = 105,
    begin_dwell = 107,
    max_presence_exceeded = 110,
    begin_exit = 111,
    /// Parameter: 0 free, 1 in step, 2 in transition. The program runs again, or is back in step.
    coordination = 150,
};
/// As the enumerations spell it; empty for a code that is never written.
std::string_view name(SignalCode code);

/// One line of the event log of a signal.
struct SignalEvent {
    double time_s = 0.0;
    std::string signal;
    std::uint32_t event = 0;      ///< SignalCode.
    std::uint32_t parameter = 0;  ///< Phase, pre-empt or state of coordination (roads/signal_numbers.hpp).
    std::string links;    ///< SUMO's link numbers, separated by spaces; of a phase, those that changed.
    std::string vehicle;  ///< SUMO's id of the emergency vehicle; text from a file.

    bool operator==(const SignalEvent&) const = default;

    static constexpr void fields(const auto& table) {
        using E = SignalEvent;
        using core::Field;
        table(Field{"time_s", "s", &E::time_s, 0.0, 1e9, "Simulation time", "clock"},
              Field{"signal", "", &E::signal, 0.0, 0.0, "Signal, SUMO's id", "network"},
              Field{"event", "1", &E::event, 0.0, 255.0, "Event code",
                    "Indiana Traffic Signal Hi Resolution Data Logger Enumerations, 2012"},
              Field{"parameter", "1", &E::parameter, 0.0, 1e6,
                    "Signal group (codes up to 23), approach as number of the pre-empt (82 to 111), or state "
                    "of coordination (150): 0 free, 1 in step, 2 in transition",
                    "network and program"},
              Field{"links", "", &E::links, 0.0, 0.0,
                    "Numbers of the links that changed or are asked for, as in SUMO's states", "network"},
              Field{"vehicle", "", &E::vehicle, 0.0, 0.0, "EV that asks, is served or passes", "demand"});
    }
};

}  // namespace clearway::metrics
