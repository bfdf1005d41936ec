#pragma once

#include <cstdint>

#include "core/fields.hpp"

namespace clearway::scenario {

/// Which crossings pedestrians use: those with a signal, or all.
enum class Crossings : std::uint8_t { signals, all };

/// Table `[pedestrians]`, optional: people who cross roads. The same in every condition; none in solo runs.
struct Pedestrians {
    double per_hour = 0.0;
    Crossings crossings = Crossings::signals;
    double speed_mean_mps = 1.34;
    double speed_deviation_mps = 0.26;

    /// Whether there are any.
    bool walk() const { return per_hour > 0.0; }

    static constexpr void fields(const auto& table) {
        using S = Pedestrians;
        table(core::Field{"per_hour", "1/h", &S::per_hour, 0.0, 2000.0,
                          "Mean number of pedestrians per crossing; they depart in [0, time.window_s].",
                          "0: scenarios v1 leave them out"},
              core::Field{"crossings", "", &S::crossings, 0, 0, "signals: only crossings with a signal; all.",
                          "signals: where policies act"},
              core::Field{"speed_mean_mps", "m/s", &S::speed_mean_mps, 0.5, 3.0, "Mean walking speed.",
                          "Weidmann 1993: 1.34"},
              core::Field{"speed_deviation_mps", "m/s", &S::speed_deviation_mps, 0.0, 1.0,
                          "Standard deviation of that speed between pedestrians, all within 0.5 to 3 m/s.",
                          "Weidmann 1993: 0.26"});
    }
};

}  // namespace clearway::scenario
