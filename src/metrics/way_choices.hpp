#pragma once

#include <cstdint>
#include <optional>

namespace clearway::metrics {

/// What an emergency vehicle's way cost against others that were driven to their ends in copies of the same
/// simulation.
struct WayChoices {
    std::uint64_t decisions = 0;  ///< Moments at which other ways were tried.
    std::uint64_t best = 0;       ///< Of these: no other way was more than a step faster.
    std::uint64_t ways = 0;       ///< Tried at them.
    double regret_s = 0.0;        ///< Time lost against the fastest of them, summed.

    bool operator==(const WayChoices&) const = default;
    std::optional<double> mean_regret_s() const {
        return decisions == 0 ? std::nullopt : std::optional(regret_s / static_cast<double>(decisions));
    }
};

}  // namespace clearway::metrics
