#pragma once

#include <cstdint>

#include "traffic/command.hpp"

namespace clearway::actuation {

/// How an Actuator acts; the same in every condition of a study.
struct ActuatorConfig {
    double yellow_s = 3.0;   ///< [0, 10]. 3 s: usual in towns.
    double all_red_s = 1.5;  ///< [0, 10]. 1.5 s: as the prototype.
    /// All red lasts up to this much longer while a vehicle that loses green is still inside the junction;
    /// [0, 30]. Assumed: a left-turner that stands there needs 4 s to leave.
    double clearing_s = 6.0;
    /// Likewise while a pedestrian is still on a crossing that those who get green will cross, or a vehicle
    /// on the way of pedestrians who get green; [0, 120], 0 where nobody walks. Assumed: 20 m at 0.5 m/s, so
    /// it ends when the crossing is empty, unless somebody is stuck there. As detectors see them.
    double walking_s = 40.0;
    /// A green is prolonged by up to this while somebody who would lose it could just stop, but not
    /// comfortably; [0, 10]. 2 s: with 0 s 5.5 emergency brakings a run at the dense intersection, with 2
    /// s 3.9.
    double gap_wait_s = 2.0;
    /// Longest time away from the own program, counted anew when the hold passes on to links that conflict
    /// with those held before; [1, 600]. 60 s: as the prototype.
    double hold_cap_s = 60.0;
    /// Own program runs at least this long between holds, and after one that reached the cap for a whole
    /// cycle (180 s at most); [0, 600]. Assumed.
    double cool_down_s = 10.0;
    double least_green_s = 10.0;  ///< A favour ends no green of the program earlier; [1, 120]. Assumed.
    traffic::SafetyChecks safety_checks = traffic::SafetyChecks::on;
    traffic::LateralModel lateral_model = traffic::LateralModel::lane;
};

}  // namespace clearway::actuation
