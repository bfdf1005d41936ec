#pragma once

#include "core/fields.hpp"

namespace clearway::prediction {

/// How twins drive (TwinTraffic), and how sure it is that a pair of them is linked.
struct CarFollowingConfig {
    double step_s = 0.5;
    double headway_s = 1.0;
    double min_gap_m = 2.5;
    /// Exponent of the free acceleration. SUMO 1.15's IDM, by which the scenarios drive unless they say
    /// otherwise.
    static constexpr double exponent = 4.0;
    double speed_factor = 1.0;
    int know_speed_factor = 0;
    int estimate = 0;
    int follow_leaders = 1;
    int obey_signals = 1;
    // Fitted: least log loss over B10 and B20, dense merge, intersection and city, three replications of
    // study seed 7001.
    /// Added to the link radius before distances are compared with it.
    static constexpr double bias_m = 0.01;
    /// Far from the radius the odds grow as this power of (distance from it / spread).
    static constexpr double tail_power = 0.475;
    /// Spread of a pair at 1 s, by the age of the older report.
    static constexpr double older_growth_m = 0.00114;
    /// The same by the age of the younger report.
    static constexpr double younger_growth_m = 0.00436;
    /// Power of the ages in s.
    static constexpr double growth_power = 1.76;

    static constexpr void fields(const auto& table) {
        using C = CarFollowingConfig;
        using core::Field;
        constexpr const char* sumo = "SUMO 1.15's IDM, the default of the scenarios";
        constexpr const char* piece = "0 shows how much this part contributes";
        table(Field{"step_s", "s", &C::step_s, 0.05, 1.0, "Step of the twins' motion",
                    "assumed: twice SUMO's own step"},
              Field{"headway_s", "s", &C::headway_s, 0.1, 5.0, "Desired time headway T", sumo},
              Field{"min_gap_m", "m", &C::min_gap_m, 0.1, 20.0, "Gap s0 at standstill", sumo},
              Field{"speed_factor", "1", &C::speed_factor, 0.2, 3.0,
                    "Desired speed divided by the speed limit", "mean of the scenarios' drivers"},
              Field{"know_speed_factor", "1", &C::know_speed_factor, 0, 1,
                    "1: each driver's own speed factor is taken from its registration, times speed_factor",
                    "off: a desired speed cannot be observed"},
              Field{"estimate", "1", &C::estimate, 0, 1,
                    "1: each driver's speed factor is estimated from the speeds that it showed",
                    "off: in trials links were not predicted better with it"},
              Field{"follow_leaders", "1", &C::follow_leaders, 0, 1, "0: twins ignore vehicles ahead", piece},
              Field{"obey_signals", "1", &C::obey_signals, 0, 1, "0: twins ignore signals", piece});
    }
};

}  // namespace clearway::prediction
