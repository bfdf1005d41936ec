// The example stays a working one.

#include <gtest/gtest.h>

#include "keep_distance.hpp"
#include "policy/straight_road.hpp"

namespace clearway::testing {
namespace {

TEST(OwnPolicyExample, slows_who_follows_closely_and_nobody_else) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        a...a.e.a..........
        ....a..............
    )");
    policy::KeepDistance policy({road.scene.network()});
    road.act(policy);
    EXPECT_NEAR(road.asked_speed("a2").value(), 8.0, 1e-5);
    EXPECT_FALSE(road.asked_speed("a1"));
    EXPECT_FALSE(road.asked_speed("a3"));
    EXPECT_FALSE(road.asked_speed("a4"));
}

TEST(OwnPolicyExample, asks_within_its_setting) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        a...a.e.a..........
    )");
    policy::KeepDistance policy({road.scene.network()}, {.reach_m = 19.0});
    road.act(policy);
    EXPECT_FALSE(road.asked_speed("a2"));
}

}  // namespace
}  // namespace clearway::testing
