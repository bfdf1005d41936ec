#pragma once

#include <cstdint>
#include <optional>

namespace clearway::metrics {

/// What choices cost against others that were tried to their ends in copies of the same simulation.
struct TriedChoices {
    std::uint64_t decisions = 0;  ///< Choices of a way, a unit or a hold, for which others were tried.
    std::uint64_t best = 0;       ///< Of these: none was more than a second faster.
    std::uint64_t tried = 0;      ///< At them.
    double regret_s = 0.0;        ///< Time lost against the fastest of them, summed.

    bool operator==(const TriedChoices&) const = default;
    std::optional<double> mean_regret_s() const { return mean(regret_s); }
    /// Of the decisions: another choice was faster.
    std::optional<double> wrong_share() const { return mean(static_cast<double>(decisions - best)); }

  private:
    std::optional<double> mean(double sum) const {
        return decisions == 0 ? std::nullopt : std::optional(sum / static_cast<double>(decisions));
    }
};

}  // namespace clearway::metrics
