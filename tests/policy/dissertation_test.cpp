#include "policy/dissertation.hpp"

#include <gtest/gtest.h>

#include "policy/straight_road.hpp"

namespace clearway::testing {
namespace {

TEST(Dissertation, lets_the_emergency_vehicle_drive_at_what_it_is_allowed) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e..h.............
    )");
    policy::Dissertation policy({road.scene.network()});
    road.act(policy);
    EXPECT_NEAR(road.asked_speed("e1").value(), 20.0, 1e-5);
}

TEST(Dissertation, sends_an_automated_vehicle_ahead_to_the_other_lane) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e..a.............
        ...................
    )");
    policy::Dissertation policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("a1"), 0U);
    EXPECT_FALSE(road.asked_speed("a1"));
}

TEST(Dissertation, slows_an_automated_vehicle_beside_but_never_to_a_standstill) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e................
        ..a................
    )");
    policy::Dissertation policy({road.scene.network()});
    road.act(policy);
    EXPECT_NEAR(road.asked_speed("a1").value(), 8.0, 1e-5);
    road.scene.set_speed("e1", core::MetresPerSecond(0.0));
    road.act(policy);
    EXPECT_NEAR(road.asked_speed("a1").value(), 5.0, 1e-5);
}

TEST(Dissertation, leaves_alone_those_behind_and_those_far_ahead_on_another_lane) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        a....e.............
        .........a.........
    )");
    policy::Dissertation policy({road.scene.network()});
    road.act(policy);
    EXPECT_FALSE(road.asked_lane("a1"));
    EXPECT_FALSE(road.asked_speed("a1"));
    EXPECT_FALSE(road.asked_lane("a2"));
    EXPECT_FALSE(road.asked_speed("a2"));
}

TEST(Dissertation, sends_nobody_into_a_lane_that_ends) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e..a.........+...........................................
        ...............+###########################################
    )");
    policy::Dissertation policy({road.scene.network()});
    road.act(policy);
    EXPECT_FALSE(road.asked_lane("a1"));
}

TEST(Dissertation, asks_a_human_driver_for_nothing) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e..h.............
        ..h................
    )");
    policy::Dissertation policy({road.scene.network()});
    EXPECT_EQ(road.act(policy).size(), 1U);
}

}  // namespace
}  // namespace clearway::testing
