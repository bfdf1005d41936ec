#pragma once

#include <gtest/gtest.h>

#include "report/overview.hpp"
#include "report/sample.hpp"
#include "report/tiles.hpp"

namespace clearway::report::tests {

/// A baseline of 100 s and one condition, `corridor`, both with 20 runs.
class Overview : public testing::Test {
  protected:
    Overview() {
        scenario_.name = "city";
        scenario_.replications = 20;
        scenario_.emergency_noun = "ambulances";
        scenario_.conditions = {condition("baseline", "baseline", 100.0),
                                condition("corridor", "corridor", 74.0)};
        compare(corridor(), around(-26.0, 4.0), around(4.6, 1.0));
        study_.scenarios = {scenario_};
    }
    ConditionFacts& corridor() { return scenario_.conditions[1]; }
    std::string headline() { return scenario_headline(scenario_, corridor(), Script::plain); }
    Tile emergency() { return emergency_tile(scenario_, corridor(), Script::plain); }
    Tile others() { return others_tile(scenario_, corridor(), Script::plain); }
    Tile safety() { return safety_tile(scenario_, corridor(), Script::plain); }
    Badge badge() { return badge_of(scenario_, corridor(), Script::plain); }
    void lose_vehicles() {
        corridor().objections.emergency = {.arrived = 17, .teleported = 3};
        corridor().objections.baseline_emergency = {.arrived = 20};
    }

    ScenarioFacts scenario_;
    StudyFacts study_;
};

}  // namespace clearway::report::tests
