#pragma once

#include <cstdint>
#include <optional>

namespace clearway::metrics {

/// How the calls of a scenario were answered in a run.
struct DispatchCounts {
    std::uint64_t sent = 0;       ///< Vehicles.
    std::uint64_t missing = 0;    ///< Called, but no station had one left that could get there.
    std::uint64_t decisions = 0;  ///< Of those sent: units of other stations were tried in copies of the run.
    std::uint64_t wrong = 0;      ///< Of these: another unit was more than a step faster.
    double regret_s = 0.0;        ///< Time lost against the fastest of them, summed.

    std::optional<double> wrong_share() const {
        return decisions == 0 ? std::nullopt
                              : std::optional(static_cast<double>(wrong) / static_cast<double>(decisions));
    }
    std::optional<double> mean_regret_s() const {
        return decisions == 0 ? std::nullopt : std::optional(regret_s / static_cast<double>(decisions));
    }
};

}  // namespace clearway::metrics
