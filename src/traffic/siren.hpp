#pragma once

#include "core/fields.hpp"

namespace clearway::traffic {

/// How human drivers react to a siren behind them. The same in every condition of a study.
struct SirenConfig {
    double compliance = 0.0;  ///< Share of drivers who yield; 0 switches the reaction off.
    double audible_m = 60.0;
    double reaction_mean_s = 1.5;
    double reaction_deviation_s = 0.5;

    static constexpr void fields(const auto& table) {
        table(core::Field{"compliance", "1", &SirenConfig::compliance, 0.0, 1.0,
                          "Share of human drivers who yield to a siren", "0: scenarios v1 leave it out"},
              core::Field{"audible_m", "m", &SirenConfig::audible_m, 5.0, 500.0,
                          "Distance along the road at which drivers notice it",
                          "assumed: closed windows in town"},
              core::Field{"reaction_mean_s", "s", &SirenConfig::reaction_mean_s, 0.0, 10.0,
                          "Mean time between noticing and acting", "assumed: surprise reaction, 1.5 s"},
              core::Field{"reaction_deviation_s", "s", &SirenConfig::reaction_deviation_s, 0.0, 5.0,
                          "Standard deviation of that time between drivers", "assumed: a third of the mean"});
    }
};

}  // namespace clearway::traffic
