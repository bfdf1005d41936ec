#pragma once

#include <cstdint>
#include <optional>

#include "actuation/actuator_config.hpp"
#include "actuation/detail/clearance.hpp"
#include "actuation/detail/link_history.hpp"
#include "traffic/preemption.hpp"

namespace clearway::actuation::detail {

/// Times of a signal's transitions, s.
struct SignalTiming {
    double yellow_s = 0.0;
    double all_red_s = 0.0;
    double clearing_s = 0.0;
    double walking_s = 0.0;
    double gap_wait_s = 0.0;
    double hold_cap_s = 0.0;
    double lockout_s = 0.0;
    double least_green_s = 0.0;
    double entry_green_s = 0.0;
    double walk_s = 0.0;
    bool enabled = true;
    int least_priority = 0;
    double delay_s = 0.0;
    double minimum_duration_s = 0.0;
    double dwell_s = 0.0;
    std::optional<std::uint32_t> exit_phase = std::nullopt;
};

/// Of one signal: the settings of the condition, and what its controller has set of its own.
SignalTiming timing_of(const ActuatorConfig& config, const traffic::Preemption& own);

/// What a signal must show its links in addition to SignalTiming.
struct SignalDuties {
    const Clearance& clearance;
    LinkHistory& history;  ///< Also told what the signal is made to show.
};

}  // namespace clearway::actuation::detail
