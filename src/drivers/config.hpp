#pragma once

#include "core/fields.hpp"
#include "traffic/privilege.hpp"
#include "traffic/siren.hpp"

namespace clearway::drivers {

using traffic::PrivilegeConfig;
using traffic::SirenConfig;

/// Which human drivers do what a policy asks of them.
struct RequestConfig {
    double compliance = 0.0;
    double hearing_m = 150.0;
    double reaction_mean_s = 1.5;
    double reaction_deviation_s = 0.5;

    static constexpr void fields(const auto& table) {
        using C = RequestConfig;
        using core::Field;
        table(Field{"compliance", "1", &C::compliance, 0.0, 1.0,
                    "Share of human drivers who do what a policy asks for an emergency vehicle",
                    "0: only automated vehicles take requests"},
              Field{"hearing_m", "m", &C::hearing_m, 1.0, 2000.0,
                    "They hear the emergency vehicle, or its request on their display, within this distance",
                    "assumed: a siren outside towns"},
              Field{"reaction_mean_s", "s", &C::reaction_mean_s, 0.0, 10.0,
                    "Mean time between hearing it and doing what is asked",
                    "assumed: surprise reaction, 1.5 s"},
              Field{"reaction_deviation_s", "s", &C::reaction_deviation_s, 0.0, 5.0,
                    "Standard deviation of that time between drivers", "assumed: a third of the mean"});
    }
};

}  // namespace clearway::drivers
