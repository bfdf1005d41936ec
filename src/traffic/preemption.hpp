#pragma once

#include <optional>

#include "core/fields.hpp"

namespace clearway::traffic {

/// Preemption parameters of one signal as its controller stores them: the objects of NTCIP 1202 v03's
/// preemptTable that apply to a request for an approach. What is not set comes from the settings of the
/// condition (`actuation.*`). `lockout_s` and `priority` are no objects of that table; controllers have them
/// beside it.
struct Preemption {
    std::optional<int> enabled = {};
    std::optional<double> delay_s = {};
    std::optional<double> minimum_green_s = {};
    std::optional<double> walk_s = {};
    std::optional<double> pedestrian_clearance_s = {};
    std::optional<double> minimum_duration_s = {};
    std::optional<double> dwell_s = {};
    std::optional<double> maximum_presence_s = {};
    std::optional<int> exit_phase = {};
    std::optional<double> lockout_s = {};
    std::optional<int> priority = {};

    bool operator==(const Preemption&) const = default;

    static constexpr void fields(const auto& table) {
        using P = Preemption;
        using core::Field;
        table(
            Field{"enabled", "1", &P::enabled, 0, 1, "0: no request for green is granted (preemptControl)",
                  "1"},
            Field{"delay_s", "s", &P::delay_s, 0.0, 600.0,
                  "A request must last this long before anything begins; one that ends sooner has no effect "
                  "(preemptDelay)",
                  "0"},
            Field{"minimum_green_s", "s", &P::minimum_green_s, 0.0, 255.0,
                  "No green ends earlier for a request, nor before the program's own minimum "
                  "(preemptMinimumGreen)",
                  "actuation.entry_green_s"},
            Field{"walk_s", "s", &P::walk_s, 0.0, 255.0,
                  "No walking green ends earlier for a request (preemptMinimumWalk)", "actuation.walk_s"},
            Field{"pedestrian_clearance_s", "s", &P::pedestrian_clearance_s, 0.0, 255.0,
                  "Red of a crossing before a green that conflicts with it, never less than in the program "
                  "(preemptEnterPedClear)",
                  "the program; without one, length of the crossing and walking speed"},
            Field{"minimum_duration_s", "s", &P::minimum_duration_s, 0.0, 65535.0,
                  "From the beginning of the transition; a hold lasts at least this long even if its request "
                  "has ended (preemptMinimumDuration)",
                  "0"},
            Field{"dwell_s", "s", &P::dwell_s, 1.0, 255.0,
                  "A hold is shown at least this long even if its request has ended (preemptDwellGreen)",
                  "none: a hold ends with its request"},
            Field{"maximum_presence_s", "s", &P::maximum_presence_s, 0.0, 65535.0,
                  "Longest time away from the program; 0: no limit (preemptMaximumPresence)",
                  "actuation.hold_cap_s"},
            Field{"exit_phase", "1", &P::exit_phase, 0, 255,
                  "Phase at which the program goes on after a hold: its row in the program, from 0 "
                  "(preemptExitPhase)",
                  "the phase that a policy asks for; otherwise the phase of the program at that time"},
            Field{"lockout_s", "s", &P::lockout_s, 0.0, 600.0,
                  "The program runs at least this long between holds", "actuation.lockout_s"},
            Field{"priority", "1", &P::priority, 0, 255,
                  "Requests of a lower priority are not granted; those of policies have priority 0 unless "
                  "they state another",
                  "0: all are"});
    }
};

}  // namespace clearway::traffic
