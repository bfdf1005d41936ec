#pragma once

#include <tuple>

#include "core/fields.hpp"
#include "traffic/privilege.hpp"
#include "traffic/siren.hpp"

namespace clearway::drivers {

using traffic::PrivilegeConfig;
using traffic::SirenConfig;

/// Settings of the drivers' reaction to a siren that no scenario sets.
struct ReactionConfig {
    double fastest_reaction_s = 0.3;
    double memory_s = 3.0;
    double lane_request_s = 2.0;

    static constexpr auto fields() {
        using C = ReactionConfig;
        using core::Field;
        return std::make_tuple(
            Field{"fastest_reaction_s", "s", &C::fastest_reaction_s, 0.0, 10.0,
                  "Shortest reaction time of any driver", "assumed: simple reaction time"},
            Field{"memory_s", "s", &C::memory_s, 0.1, 60.0,
                  "A siren that was not heard for this long is forgotten", "assumed"},
            Field{"lane_request_s", "s", &C::lane_request_s, 0.1, 60.0,
                  "How long a driver tries to reach one lane before choosing again", "assumed"});
    }
};

/// Which human drivers do what a policy asks of them.
struct RequestConfig {
    double compliance = 0.0;
    double hearing_m = 150.0;
    double reaction_mean_s = 1.5;
    double reaction_deviation_s = 0.5;
    double fastest_reaction_s = 0.3;
    double memory_s = 3.0;

    static constexpr auto fields() {
        using C = RequestConfig;
        using core::Field;
        return std::make_tuple(
            Field{"compliance", "1", &C::compliance, 0.0, 1.0,
                  "Share of human drivers who do what a policy asks for an emergency vehicle",
                  "0: only automated vehicles take requests"},
            Field{"hearing_m", "m", &C::hearing_m, 1.0, 2000.0,
                  "They hear the emergency vehicle, or its request on their display, within this distance",
                  "assumed: a siren outside towns"},
            Field{"reaction_mean_s", "s", &C::reaction_mean_s, 0.0, 10.0,
                  "Mean time between hearing it and doing what is asked",
                  "assumed: surprise reaction, 1.5 s"},
            Field{"reaction_deviation_s", "s", &C::reaction_deviation_s, 0.0, 5.0,
                  "Standard deviation of that time between drivers", "assumed: a third of the mean"},
            Field{"fastest_reaction_s", "s", &C::fastest_reaction_s, 0.0, 10.0,
                  "Shortest reaction time of any driver", "assumed: simple reaction time"},
            Field{"memory_s", "s", &C::memory_s, 0.1, 60.0,
                  "An emergency vehicle that was not heard for this long is forgotten", "assumed"});
    }
};

}  // namespace clearway::drivers
