#include "policy/clear_lane.hpp"

#include <gtest/gtest.h>

#include "policy/straight_road.hpp"

namespace clearway::testing {
namespace {

TEST(ClearLane, sends_automated_vehicles_far_ahead_out_of_the_lane_and_holds_the_others_beside_it) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ..e..a........a.............a......
        ..........a........................
    )");
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("a1"), 0U);
    EXPECT_EQ(road.asked_lane("a2"), 0U) << "120 m ahead";
    EXPECT_FALSE(road.asked_lane("a3")) << "260 m ahead";
    EXPECT_TRUE(road.asked<traffic::HoldLane>("a4"));
}

TEST(ClearLane, chooses_the_way_out_with_more_room) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ...................
        ..e..a.............
        .....h.............
    )");
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("a1"), 2U);
}

TEST(ClearLane, sends_nobody_into_a_lane_that_ends) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ..e..a.........+...........................................
        ...............+###########################################
    )");
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_FALSE(road.asked_lane("a1"));
}

TEST(ClearLane, takes_the_emergency_vehicle_to_the_lane_with_less_delay) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ..e..h.............
        ...................
    )");
    road.scene.set_speed("h1", core::MetresPerSecond(8.0));
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U);
}

TEST(ClearLane, leaves_the_emergency_vehicle_where_a_change_is_not_worth_it) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ..e..h.............
        ...................
    )");
    road.scene.set_speed("h1", core::MetresPerSecond(19.3));
    policy::ClearLane policy({road.scene.network()});
    EXPECT_TRUE(road.act(policy).empty()) << "0.3 s over the next kilometre";
    road.scene.set_speed("h1", core::MetresPerSecond(19.0));
    EXPECT_FALSE(road.act(policy).empty()) << "1.1 s";
}

TEST(ClearLane, opens_a_gap_on_the_lane_that_the_emergency_vehicle_wants) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ..e..h.............
        .a.................
    )");
    road.scene.set_speed("h1", core::MetresPerSecond(5.0));
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U);
    EXPECT_NEAR(road.asked_speed("a1").value(), 12.0, 1e-5);
}

TEST(ClearLane, counts_a_queue_and_takes_the_shorter_one) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ..e.............hhh|r......................................
        .................h.|r......................................
    )");
    for (const char* id : {"h1", "h2", "h3", "h4"})
        road.scene.set_speed(id, core::MetresPerSecond(0.0));
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U);
}

/// The lane beside is dense from here on; behind there is a gap. The queue ahead stands.
constexpr const char* gap_behind = R"(
        10 m per cell, limit 15 m/s, speed 15 m/s
        ............e..............................hhhh|r...............................
        ....a.....h..h...h...h...h...h...h...h.........|r...............................
    )";

TEST(ClearLane, lets_the_emergency_vehicle_fall_back_to_a_gap_before_a_queue_and_keeps_it_open) {
    StraightRoad road(gap_behind);
    road.stop({"h1", "h2", "h3", "h4"});
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U);
    EXPECT_NEAR(road.asked_speed("e1").value(), 10.0, 1e-5) << "5 m/s slower than the traffic there";
    EXPECT_NEAR(road.asked_speed("a1").value(), 12.0, 1e-5) << "the one behind the gap";
}

TEST(ClearLane, does_not_fall_back_for_less_than_it_costs) {
    StraightRoad road(gap_behind);
    road.stop({"h1", "h2"});
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U) << "the lane beside is faster";
    EXPECT_FALSE(road.asked_speed("e1")) << "42 m back cost 3 s of the 4 that it gains";
    EXPECT_FALSE(road.asked_speed("a1"));
}

TEST(ClearLane, stays_beside_a_gap_that_is_wide_enough) {
    StraightRoad road(R"(
        10 m per cell, limit 15 m/s, speed 15 m/s
        ............e..............................hhhh|r...............................
        ........h........h...h...h...h...h...h.........|r...............................
    )");
    road.stop({"h1", "h2", "h3", "h4"});
    policy::ClearLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U);
    EXPECT_FALSE(road.asked_speed("e1"));
}

TEST(ClearLane, does_nothing_on_a_free_road) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        a.e................
        h..................
    )");
    policy::ClearLane policy({road.scene.network()});
    EXPECT_TRUE(road.act(policy).empty());
}

}  // namespace
}  // namespace clearway::testing
