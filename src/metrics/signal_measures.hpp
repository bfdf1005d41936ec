#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "metrics/signal_event.hpp"

namespace clearway::metrics {

/// How a signal served emergency vehicles in a run, from its event log. A call is one from its beginning
/// (code 102) to its end (104). A hold is shown from 107 until the exit (111) or the end of its call, and is
/// useless if its vehicle did not pass in it, as metrics::RunMetrics counts it, too. Times are means.
struct SignalMeasures {
    std::string signal;
    std::uint64_t calls = 0;
    std::uint64_t granted = 0;
    std::uint64_t useless_holds = 0;
    std::uint64_t capped = 0;
    std::optional<double> entry_delay_s;
    std::optional<double> time_to_service_s;
    std::optional<double> dwell_s;
    std::optional<double> recovery_s;

    bool operator==(const SignalMeasures&) const = default;

    static constexpr void fields(const auto& table) {
        using M = SignalMeasures;
        using core::Field;
        table(
            Field{"signal", "", &M::signal, 0.0, 0.0, "Signal, SUMO's id; empty for all of a run", "network"},
            Field{"calls", "1", &M::calls, 0.0, 1e9, "Requests of an EV that reached the signal", "102"},
            Field{"granted", "1", &M::granted, 0.0, 1e9, "Of them: a hold was shown", "102, 107"},
            Field{"useless_holds", "1", &M::useless_holds, 0.0, 1e9,
                  "Holds that were shown and ended without their EV having passed the stop line",
                  "107, 82, 104, 111"},
            Field{"capped", "1", &M::capped, 0.0, 1e9, "Holds that reached their longest time", "110"},
            Field{"entry_delay_s", "s", &M::entry_delay_s, 0.0, 1e9,
                  "From the call to the start of the transition", "102, 105"},
            Field{"time_to_service_s", "s", &M::time_to_service_s, 0.0, 1e9,
                  "From the call to green for the EV", "102, 107"},
            Field{"dwell_s", "s", &M::dwell_s, 0.0, 1e9, "How long a hold was shown", "107, 104, 111"},
            Field{"recovery_s", "s", &M::recovery_s, 0.0, 1e9,
                  "From the end of a hold until the program runs again, in step where it is coordinated",
                  "111, 150"});
    }
};

/// By signal, in the order of their ids; then, unless there is none, all together without an id.
std::vector<SignalMeasures> signal_measures(std::span<const SignalEvent> events);

}  // namespace clearway::metrics
