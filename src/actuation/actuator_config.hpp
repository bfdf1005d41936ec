#pragma once

#include <cstdint>

#include "traffic/command.hpp"

namespace clearway::actuation {

/// Whether vehicles have a position within their lane (SUMO's sublane model).
enum class LateralModel : std::uint8_t { lane, sublane };

/// How an Actuator acts; the same in every condition of a study.
struct ActuatorConfig {
    double yellow_s = 3.0;   ///< [0, 10]. facts: 3 s.
    double all_red_s = 1.5;  ///< [0, 10]. facts: 1.5 s.
    /// All red lasts up to this much longer while a vehicle that loses green is still inside the junction;
    /// [0, 30]. Assumed: a left-turner that stands there needs 4 s to leave.
    double clearing_s = 6.0;
    double hold_cap_s = 60.0;     ///< Longest time away from the own program; [1, 600]. facts: 60 s.
    double cool_down_s = 10.0;    ///< Own program runs at least this long between holds; [0, 600]. Assumed.
    double least_green_s = 10.0;  ///< A favour ends no green of the program earlier; [1, 120]. Assumed.
    traffic::SafetyChecks safety_checks = traffic::SafetyChecks::on;
    LateralModel lateral_model = LateralModel::lane;
};

}  // namespace clearway::actuation
