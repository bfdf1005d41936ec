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
    EXPECT_NEAR(road.asked_speed("a2").value_or(-1.0), 8.0, 1e-5);
    EXPECT_FALSE(road.asked_speed("a1"));
    EXPECT_FALSE(road.asked_speed("a3"));
    EXPECT_FALSE(road.asked_speed("a4"));
}

TEST(OwnPolicyExample, asks_within_its_setting) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        a...a.e.a..........
    )");
    policy::KeepDistanceConfig config;
    config.reach_m = 19.0;
    policy::KeepDistance policy({road.scene.network()}, config);
    road.act(policy);
    EXPECT_FALSE(road.asked_speed("a2"));
}

TEST(OwnPolicyExample, asks_for_no_more_than_the_follower_may_drive) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        a...a.e.a..........
    )");
    road.scene.set_speed("e1", core::MetresPerSecond(30.0));
    policy::KeepDistance policy({road.scene.network()});
    road.act(policy);
    EXPECT_NEAR(road.asked_speed("a2").value_or(-1.0), 20.0, 1e-5);
}

TEST(OwnPolicyExample, asks_drivers_only_when_it_is_told_to) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ....h.e............
    )");
    policy::KeepDistanceConfig config;
    policy::KeepDistance usual({road.scene.network()}, config);
    EXPECT_TRUE(road.act(usual).empty());
    config.ask_humans = 1;
    policy::KeepDistance drivers_too({road.scene.network()}, config);
    EXPECT_EQ(road.act(drivers_too).size(), 1U);
}

}  // namespace
}  // namespace clearway::testing
