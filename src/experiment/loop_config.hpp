#pragma once

#include <tuple>

#include "core/fields.hpp"

namespace clearway::experiment {

/// Period of decisions and radius of links in the closed loop. A condition may set the members by name.
struct LoopConfig {
    double policy_period_s = 0.5;  ///< Time between two decisions of the policy.
    double link_radius_m = 50.0;

    static constexpr auto fields() {
        return std::make_tuple(
            core::Field{"policy_period_s", "s", &LoopConfig::policy_period_s, 0.1, 10.0,
                        "Time between two decisions of the policy", "assumed: half a report interval"},
            core::Field{"link_radius_m", "m", &LoopConfig::link_radius_m, 1.0, 1000.0,
                        "Vehicles nearer than this are linked",
                        "assumed 50 m: the dissertation states no value"});
    }
};

}  // namespace clearway::experiment
