#include "actuation/detail/signal_timing.hpp"

#include <limits>

namespace clearway::actuation::detail {

SignalTiming timing_of(const ActuatorConfig& config, const traffic::Preemption& own) {
    SignalTiming timing{yellow_on_road_s(config.yellow_s, config.friction),
                        config.all_red_s,
                        config.clearing_s,
                        config.walking_s,
                        config.gap_wait_s,
                        config.hold_cap_s,
                        config.lockout_s,
                        config.least_green_s,
                        config.entry_green_s,
                        config.walk_s};
    timing.enabled = own.enabled.value_or(1) != 0;
    timing.least_priority = own.priority.value_or(0);
    timing.delay_s = own.delay_s.value_or(0.0);
    timing.entry_green_s = own.minimum_green_s.value_or(config.entry_green_s);
    timing.walk_s = own.walk_s.value_or(config.walk_s);
    timing.minimum_duration_s = own.minimum_duration_s.value_or(0.0);
    timing.dwell_s = own.dwell_s.value_or(0.0);
    timing.hold_cap_s = own.maximum_presence_s.value_or(config.hold_cap_s);
    if (timing.hold_cap_s <= 0.0) timing.hold_cap_s = std::numeric_limits<double>::infinity();
    timing.lockout_s = own.lockout_s.value_or(config.lockout_s);
    if (own.exit_phase) timing.exit_phase = static_cast<std::uint32_t>(*own.exit_phase);
    return timing;
}

}  // namespace clearway::actuation::detail
