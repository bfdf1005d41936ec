#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "core/ids.hpp"

namespace clearway::metrics {

/// What the incidents of a scenario led to in a run.
struct IncidentCounts {
    /// EVs that came to a road which an incident closed to them, and when they first did, s.
    std::map<core::VehicleKey, double> emergency_met_s = {};
    std::uint64_t emergency_turned = 0;   ///< Of those: their crews took another way.
    std::uint64_t emergency_cut_off = 0;  ///< Of those: their crews found no other way.
    std::uint64_t others_rerouted = 0;    ///< Other vehicles that took another way.
    /// Longest time from an incident's start until all its lanes were blocked, s.
    std::optional<double> delay_s = {};
};

}  // namespace clearway::metrics
