#pragma once

#include "core/fields.hpp"

namespace clearway::traffic {

/// What the law allows emergency vehicles beyond other traffic. The same in every condition of a study, the
/// baseline included.
struct PrivilegeConfig {
    int pass_red = 0;
    double red_mps = 5.56;
    double red_near_m = 200.0;
    double red_braking_mps2 = 2.0;
    int between_lanes = 0;
    double margin_m = 0.4;
    double between_mps = 11.1;
    double look_m = 60.0;

    bool none() const { return pass_red == 0 && between_lanes == 0; }
    bool operator==(const PrivilegeConfig&) const = default;

    static constexpr void fields(const auto& table) {
        using C = PrivilegeConfig;
        using core::Field;
        table(
            Field{"pass_red", "1", &C::pass_red, 0, 1,
                  "1: emergency vehicles pass red signals, slowly and yielding to traffic that has green",
                  "0: earlier scenarios leave it out"},
            Field{"red_mps", "m/s", &C::red_mps, 0.5, 30.0, "Highest speed at a stop line that shows red",
                  "20 km/h, assumed: slow enough to stop for traffic that has green"},
            Field{"red_near_m", "m", &C::red_near_m, 1.0, 1000.0,
                  "The privilege begins at this distance from a signal that is not green",
                  "assumed: before the vehicle would brake"},
            Field{"red_braking_mps2", "m/s2", &C::red_braking_mps2, 0.1, 9.0,
                  "Emergency vehicles slow down to that speed with this deceleration", "comfortable"},
            Field{
                "between_lanes", "1", &C::between_lanes, 0, 1,
                "1: emergency vehicles drive between two lanes where there is room; needs the sublane model",
                "0: earlier scenarios leave it out"},
            Field{"margin_m", "m", &C::margin_m, 0.0, 2.0,
                  "Room that the emergency vehicle keeps to vehicles beside it, both sides together",
                  "assumed: a driver who squeezes through"},
            Field{"between_mps", "m/s", &C::between_mps, 0.5, 40.0,
                  "Highest speed while a vehicle is beside it with less than a metre of room",
                  "40 km/h, assumed"},
            Field{"look_m", "m", &C::look_m, 5.0, 300.0,
                  "Vehicles this far ahead decide on which side to pass",
                  "assumed: the stopping distance from 60 km/h"});
    }
};

}  // namespace clearway::traffic
