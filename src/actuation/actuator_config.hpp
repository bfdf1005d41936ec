#pragma once

#include <vector>

#include "actuation/clearance_rule.hpp"
#include "core/fields.hpp"
#include "traffic/command.hpp"
#include "traffic/preemption.hpp"

namespace clearway::actuation {

/// How an Actuator acts.
struct ActuatorConfig {
    double yellow_s = 3.0;
    double all_red_s = 1.5;
    double clearing_s = 6.0;
    double walking_s = 40.0;
    double gap_wait_s = 2.0;
    double hold_cap_s = 60.0;
    double lockout_s = 10.0;
    double least_green_s = 10.0;
    ClearanceRule clearance = ClearanceRule::rilsa;
    double entry_green_s = 5.0;
    double walk_s = 7.0;
    traffic::SafetyChecks safety_checks = traffic::SafetyChecks::on;
    traffic::LateralModel lateral_model = traffic::LateralModel::lane;
    std::vector<traffic::Preemption> preemption = {};  ///< By signal; empty: none is set.
    double friction = 1.0;  ///< Share of a dry road's grip; on a slippery road each yellow is longer.

    static constexpr void fields(const auto& table) {
        using C = ActuatorConfig;
        using core::Field;
        table(
            Field{
                "yellow_s", "s", &C::yellow_s, 0.0, 10.0,
                "Shortest yellow before a green is withdrawn, on a dry road. With `clearance` `fixed` it is "
                "the yellow. On a slippery road each yellow is longer, also that of the signal's own program",
                "the shortest of ITE, MUTCD and RiLSA"},
            Field{"all_red_s", "s", &C::all_red_s, 0.0, 10.0,
                  "With `clearance` `fixed`: red of a link before a conflicting link gets green. Otherwise: "
                  "only before a green to which a link that had right of way must yield",
                  "assumed: usual in towns"},
            Field{"clearing_s", "s", &C::clearing_s, 0.0, 30.0,
                  "A conflicting green waits up to this much longer while a vehicle that has lost green is "
                  "still inside the junction",
                  "assumed: a waiting left-turner needs 4 s to leave"},
            Field{"walking_s", "s", &C::walking_s, 0.0, 120.0,
                  "A green waits up to this much longer while a pedestrian is on a crossing that vehicles "
                  "with green will cross, or "
                  "a vehicle is in the way of pedestrians who get green; 0 without pedestrians",
                  "assumed: 20 m at 0.5 m/s, so that it ends when the crossing is empty, unless somebody is "
                  "stuck there"},
            Field{"gap_wait_s", "s", &C::gap_wait_s, 0.0, 10.0,
                  "A green is extended by up to this while a vehicle that would lose it could stop, but not "
                  "comfortably",
                  "trials at the dense intersection: fewer emergency brakings than without it"},
            Field{"hold_cap_s", "s", &C::hold_cap_s, 1.0, 600.0,
                  "Longest time away from the signal's background plan; restarts when the hold passes "
                  "to links that conflict with those held before",
                  "assumed"},
            Field{"lockout_s", "s", &C::lockout_s, 0.0, 600.0,
                  "The signal's background plan runs at least this long between holds; after a hold that "
                  "reached the cap, also for a whole cycle (180 s at most)",
                  "assumed"},
            Field{"least_green_s", "s", &C::least_green_s, 1.0, 120.0,
                  "No green of the background plan ends earlier while a signal recovers", "assumed"},
            Field{
                "clearance", "", &C::clearance, 0.0, 0.0,
                "Least yellow and red clearance of each link that loses green: `ite` and `rilsa` are what "
                "the "
                "signal's own program shows, or, where it shows none, what the formulas of the ITE or of "
                "RiLSA give for speed limit and crossing, and a link waits only for those that conflict with "
                "it; `fixed` is `yellow_s` and `all_red_s` for all links, whatever the program shows",
                "no transition may be faster than the program allows, and the rule counts the whole time "
                "between "
                "two greens; older figures were made with `fixed`"},
            Field{"entry_green_s", "s", &C::entry_green_s, 0.0, 60.0,
                  "No green ends earlier for a hold, nor before the program's own minimum",
                  "NTCIP 1202 v03, preemptMinimumGreen: set by the city; 5 s assumed"},
            Field{"walk_s", "s", &C::walk_s, 0.0, 60.0, "No pedestrian green ends earlier for a hold",
                  "MUTCD 2009, 4E.06: 7 s, at least 4 s"});
    }
};

}  // namespace clearway::actuation
