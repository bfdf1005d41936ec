#include "policy/listing_5_5.hpp"

#include <gtest/gtest.h>

#include "policy/straight_road.hpp"

namespace clearway::testing {
namespace {

TEST(Listing55, speeds_the_emergency_vehicle_up_by_a_tenth_and_slows_linked_automated_ones_by_a_fifth) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ....a.....h.......a
        ..e................
    )");
    policy::Listing55 policy({road.scene.network()});
    road.act(policy);
    EXPECT_NEAR(road.asked_speed("e1").value(), 11.0, 1e-5);
    EXPECT_NEAR(road.asked_speed("a1").value(), 8.0, 1e-5);
    EXPECT_FALSE(road.asked_speed("a2")) << "160 m away: not linked";
    EXPECT_FALSE(road.asked_speed("h1"));
}

TEST(Listing55, does_not_ask_for_more_than_the_limit) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 19 m/s
        ..e.a..............
    )");
    policy::Listing55 policy({road.scene.network()});
    road.act(policy);
    EXPECT_NEAR(road.asked_speed("e1").value(), 20.0, 1e-5);
}

TEST(Listing55, keeps_an_emergency_vehicle_that_stands_standing_as_published) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e.a..............
    )");
    road.scene.set_speed("e1", core::MetresPerSecond(0.0));
    policy::Listing55 policy({road.scene.network()});
    road.act(policy);
    EXPECT_DOUBLE_EQ(road.asked_speed("e1").value(), 0.0);
}

TEST(Listing55, never_releases_a_speed_although_the_link_is_gone_as_published) {
    StraightRoad road(R"(
        10 m per cell, limit 40 m/s, speed 10 m/s
        ..e..a.............
    )");
    policy::Listing55 policy({road.scene.network()});
    road.act(policy);
    road.scene.set_speed("e1", core::MetresPerSecond(1.0));
    road.scene.set_speed("a1", core::MetresPerSecond(14.0));
    road.scene.pass(core::Seconds(9.0));
    road.act(policy);
    EXPECT_NEAR(road.asked_speed("a1").value(), 8.0, 1e-5) << "the speed set when it was linked";
}

TEST(Listing55, leaves_the_lane_of_an_automated_vehicle_outwards) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e..a.............
        ...................
    )");
    policy::Listing55 policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U);
}

TEST(Listing55, goes_to_the_centre_when_it_is_free_and_swings_back_as_published) {
    StraightRoad outer(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        .....h.............
        ..e................
    )");
    policy::Listing55 first({outer.scene.network()});
    outer.act(first);
    EXPECT_EQ(outer.asked_lane("e1"), 1U);
    StraightRoad centre(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e..h.............
        ...................
    )");
    policy::Listing55 second({centre.scene.network()});
    centre.act(second);
    EXPECT_EQ(centre.asked_lane("e1"), 0U);
}

TEST(Listing55, stays_where_the_other_lane_is_taken_beside_it) {
    StraightRoad road(R"(
        5 m per cell, limit 20 m/s, speed 10 m/s
        ...h...............
        ..e................
    )");
    policy::Listing55 policy({road.scene.network()});
    road.act(policy);
    EXPECT_FALSE(road.asked_lane("e1"));
}

TEST(Listing55, needs_enough_edges) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..e..a.............
    )");
    policy::Listing55Config config;
    config.min_edges = 2;
    policy::Listing55 policy({road.scene.network()}, config);
    EXPECT_TRUE(road.act(policy).empty());
}

}  // namespace
}  // namespace clearway::testing
