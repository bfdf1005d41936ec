#pragma once

#include <tuple>

#include "core/fields.hpp"

namespace clearway::experiment {

/// How the closed loop of a run is timed and what counts as near. A condition may set its members by name.
struct LoopConfig {
    double policy_period_s = 0.5;  ///< Between two decisions of the policy.
    double link_radius_m = 50.0;

    static constexpr auto fields() {
        return std::make_tuple(
            core::Field{"policy_period_s", "s", &LoopConfig::policy_period_s, 0.1, 10.0,
                        "Time between two decisions of the policy", "assumed: half a report interval"},
            core::Field{"link_radius_m", "m", &LoopConfig::link_radius_m, 1.0, 1000.0,
                        "Two vehicles nearer than this are linked",
                        "assumed 50 m: the dissertation states no value"});
    }
};

}  // namespace clearway::experiment
