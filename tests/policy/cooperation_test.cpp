// The parts that ask vehicles on a straight road or across it to give way: vacate_lane, pull_aside,
// hold_cross, rescue_lane. geocast, give_way and pull_over have files of their own.

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "policy/conformance.hpp"
#include "policy/detail/lane_plan.hpp"
#include "policy/hold_cross.hpp"
#include "policy/pull_aside.hpp"
#include "policy/rescue_lane.hpp"
#include "policy/straight_road.hpp"
#include "policy/vacate_lane.hpp"

namespace clearway::testing {
namespace {

using traffic::Side;

TEST(VacateLane, plans_round_one_who_will_not_make_room_and_clears_that_way) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ......e.....a.h|r...............................................
        ..............a|r...............................................
    )");
    road.stop({"a1", "a2", "h1"});
    policy::VacateLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U) << "h1 stands in its lane";
    EXPECT_EQ(road.asked_lane("a2"), 1U) << "in the way, on the lane that is cleared";
    EXPECT_TRUE(road.asked<traffic::HoldLane>("a1")) << "beside the way";
    EXPECT_FALSE(road.asked_lane("h1"));
}

TEST(VacateLane, keeps_the_lane_where_everybody_is_asked) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 12 m/s
        ......e.....a.a|r...............................................
        ............a.a|r...............................................
    )");
    road.stop({"a1", "a2", "a3", "a4"});
    policy::VacateLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_FALSE(road.asked_lane("e1"));
    EXPECT_EQ(road.asked_lane("a1"), 0U);
    EXPECT_EQ(road.asked_lane("a2"), 0U);
    EXPECT_TRUE(road.asked<traffic::HoldLane>("a3"));
    EXPECT_TRUE(road.asked<traffic::HoldLane>("a4"));
}

TEST(VacateLane, asks_human_drivers_only_where_told_to) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 12 m/s
        ......e.....h...................................................
        ................................................................
    )");
    policy::VacateLaneConfig config;
    policy::VacateLane automated({road.scene.network()}, config);
    road.act(automated);
    EXPECT_FALSE(road.asked_lane("h1"));
    config.ask_humans = 1;
    config.change_s = 100.0;  // so that the emergency vehicle does not simply go round
    policy::VacateLane all({road.scene.network()}, config);
    road.act(all);
    EXPECT_EQ(road.asked_lane("h1"), 0U);
}

TEST(VacateLane, that_asks_the_linked_plans_round_those_it_is_not_linked_with) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 12 m/s
        ......e...a.......a.............................................
        ................................................................
    )");
    road.stop({"a1", "a2"});
    policy::VacateLaneConfig config;
    config.ask = policy::Ask::linked;
    policy::VacateLane policy({road.scene.network()}, config);
    road.act(policy);
    EXPECT_FALSE(road.asked_lane("a2")) << "120 m ahead: no link";
    EXPECT_EQ(road.asked_lane("e1"), 0U) << "round the one that stays";
}

TEST(VacateLane, asks_nobody_beyond_its_horizon) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 12 m/s
        e.........a.........a...........................................
        ................................................................
    )");
    policy::VacateLaneConfig config;
    config.horizon_m = 150.0;
    policy::VacateLane policy({road.scene.network()}, config);
    road.act(policy);
    EXPECT_TRUE(road.asked_lane("a1"));
    EXPECT_FALSE(road.asked_lane("a2"));
}

TEST(PullAside, asks_the_queue_on_the_way_and_not_the_lane_beside) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 12 m/s
        ......e.....a.a|r...............................................
        ............a.a|r...............................................
    )");
    road.stop({"a1", "a2", "a3", "a4"});
    policy::PullAside policy({road.scene.network()});
    road.act(policy);
    EXPECT_TRUE(road.asked<traffic::PullAside>("a1"));
    EXPECT_TRUE(road.asked<traffic::PullAside>("a2"));
    EXPECT_FALSE(road.asked<traffic::PullAside>("a3"));
    EXPECT_FALSE(road.asked<traffic::PullAside>("a4"));
}

TEST(PullAside, lets_fast_vehicles_drive_on) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 19 m/s
        ......e.....a...................................................
    )");
    policy::PullAside policy({road.scene.network()});
    EXPECT_TRUE(road.act(policy).empty());
}

TEST(PullAside, renews_for_those_who_vanished_beside_the_road_until_it_has_passed_them) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ......e.....a...................................................
    )");
    road.stop({"a1"});
    policy::PullAside policy({road.scene.network()});
    road.act(policy);
    traffic::BelievedGraph belief = support::perfect_belief(road.scene);
    const auto renewals = [&](float emergency_m) {
        traffic::BelievedGraph alone = belief;
        std::erase_if(alone.vehicles,
                      [&](const auto& vehicle) { return vehicle.key == road.scene.key("a1"); });
        alone.first_link.assign(alone.vehicles.size() + 1, 0);
        alone.links.clear();
        alone.vehicles.front().state.lane_position_m = emergency_m;
        alone.own_states = alone.vehicles;
        std::vector<traffic::Lease> leases;
        policy.act(alone, leases);
        return leases.size();
    };
    EXPECT_EQ(renewals(80.0F), 1U) << "it stands at 125 m";
    EXPECT_EQ(renewals(110.0F), 1U);
    EXPECT_EQ(renewals(140.0F), 0U) << "passed";
    EXPECT_EQ(renewals(100.0F), 0U) << "and forgotten";
}

TEST(RescueLane, sends_the_left_lane_to_the_left_edge_and_the_others_to_the_right) {
    StraightRoad road(R"(
        10 m per cell, limit 30 m/s, speed 2 m/s
        ...a..a.....
        .e..a.......
        ...a........
    )");
    policy::RescueLane policy({road.scene.network()});
    road.act(policy);
    const auto side = [&](const char* id) { return road.asked<traffic::PullAside>(id).value().side; };
    EXPECT_EQ(side("a1"), Side::left);
    EXPECT_EQ(side("a2"), Side::left);
    EXPECT_EQ(side("a3"), Side::right);
    EXPECT_EQ(side("a4"), Side::right);
}

TEST(RescueLane, leaves_flowing_traffic_alone) {
    StraightRoad road(R"(
        10 m per cell, limit 30 m/s, speed 25 m/s
        ...a..a.....
        .e..a.......
    )");
    policy::RescueLane policy({road.scene.network()});
    EXPECT_TRUE(road.act(policy).empty());
}

TEST(RescueLane, is_formed_by_who_is_beside_the_emergency_vehicle_too_and_just_behind) {
    StraightRoad road(R"(
        5 m per cell, limit 30 m/s, speed 2 m/s
        ....a...a....
        a....e....a..
    )");
    policy::RescueLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked<traffic::PullAside>("a1").value().side, Side::left)
        << "its front is 5 m behind the other's: in the middle of its lane it would hold the other there";
    EXPECT_TRUE(road.asked<traffic::PullAside>("a3")) << "25 m behind";
    policy::RescueLaneConfig config;
    config.behind_m = 0.0;
    policy::RescueLane blind({road.scene.network()}, config);
    road.act(blind);
    EXPECT_FALSE(road.asked<traffic::PullAside>("a1"));
    EXPECT_TRUE(road.asked<traffic::PullAside>("a2"));
}

TEST(RescueLane, is_not_for_those_who_come_fast_towards_the_jam) {
    StraightRoad road(R"(
        10 m per cell, limit 30 m/s, speed 2 m/s
        .....a......a.
        .e..........a.
    )");
    road.scene.set_speed("a1", core::MetresPerSecond(20.0));
    policy::RescueLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_EQ(road.asked<traffic::PullAside>("a1").value().side, Side::left)
        << "it would drive into the jam between the lanes";
}

TEST(RescueLane, lies_where_fewer_stand_who_are_not_asked) {
    StraightRoad road(R"(
        5 m per cell, limit 30 m/s, speed 2 m/s
        ...h.h.h.h..
        .e..a..a....
        ...a..a.....
    )");
    policy::RescueLane policy({road.scene.network()});
    road.act(policy);
    const auto side = [&](const char* id) { return road.asked<traffic::PullAside>(id).value().side; };
    EXPECT_EQ(side("a1"), Side::left) << "the middle lane: the rescue lane is right of it";
    EXPECT_EQ(side("a3"), Side::right);
}

TEST(RescueLane, moves_two_abreast_apart_who_leave_too_little_room) {
    StraightRoad road(R"(
        5 m per cell, limit 30 m/s, speed 2 m/s
        .....h.a....
        .e...h.a....
    )");
    policy::RescueLaneConfig config;
    config.room_m = 0.2;  // so that one who is asked leaves enough beside one who is not, on lanes of 3.2 m
    policy::RescueLane policy({road.scene.network()}, config);
    road.act(policy);
    const int slowed = int(road.asked_speed("a1").has_value()) + int(road.asked_speed("a2").has_value());
    EXPECT_EQ(slowed, 1) << "who drives ahead of one of the two";

    StraightRoad apart(R"(
        5 m per cell, limit 30 m/s, speed 2 m/s
        .....h....a..
        .e........ha.
    )");
    policy::RescueLane again({apart.scene.network()}, config);
    apart.act(again);
    EXPECT_FALSE(apart.asked_speed("a1")) << "20 m lie between them";
    EXPECT_FALSE(apart.asked_speed("a2"));
}

TEST(RescueLane, keeps_one_beside_the_emergency_vehicle_back_until_that_has_room_to_steer) {
    StraightRoad road(R"(
        5 m per cell, limit 30 m/s, speed 2 m/s
        .......h..
        ...ae.....
    )");
    policy::RescueLane policy({road.scene.network()});
    road.act(policy);
    EXPECT_TRUE(road.asked_speed("a1")) << "who is ahead of it cannot be asked";
    StraightRoad passed(R"(
        5 m per cell, limit 30 m/s, speed 2 m/s
        ....h......a
        ...ae.....a.
    )");
    passed.act(policy);
    EXPECT_FALSE(passed.asked_speed("a1")) << "the other is level";
}

TEST(RescueLane, stands_back_in_towns_and_near_signals_and_says_so) {
    const char* const town = R"(
        5 m per cell, limit 14 m/s, speed 2 m/s
        .....a......
        .e..........
    )";
    const char* const before = R"(
        5 m per cell, limit 30 m/s, speed 2 m/s
        .....a......|r......
        .e..........|r......
    )";
    const char* const behind = R"(
        5 m per cell, limit 30 m/s, speed 2 m/s
        ......|r.....a......
        ......|r.e..........
    )";
    for (const char* const drawing : {town, before, behind}) {
        StraightRoad road(drawing);
        policy::RescueLane policy({road.scene.network()});
        EXPECT_EQ(road.act(policy).size(), 1U) << drawing;
        EXPECT_TRUE(road.asked<traffic::StandBack>("e1")) << drawing;
        road.scene.set_speed("a1", core::MetresPerSecond(14.0));
        EXPECT_TRUE(road.act(policy).empty()) << drawing << "nobody is slow: there is nothing to do";
        road.scene.set_speed("a1", core::MetresPerSecond(2.0));
        policy::RescueLaneConfig anywhere;
        anywhere.least_limit_mps = 0.0;
        anywhere.signal_m = 0.0;
        policy::RescueLane eager({road.scene.network()}, anywhere);
        road.act(eager);
        EXPECT_TRUE(road.asked<traffic::PullAside>("a1")) << drawing;
        EXPECT_FALSE(road.asked<traffic::StandBack>("e1")) << drawing;
    }
}

TEST(HoldCross, stops_cross_traffic_that_has_green_and_only_shortly_before_the_arrival) {
    ActuationBench bench;
    const auto emergency =
        bench.add({"e", traffic::VehicleClass::emergency, {"west_A", "A_B", "B_east"}, 1, 450.0, 12.0});
    const auto near =
        bench.add({"n", traffic::VehicleClass::automated, {"north_a_A", "A_south_a"}, 0, 250.0, 8.0});
    const auto far =
        bench.add({"f", traffic::VehicleClass::automated, {"north_a_A", "A_south_a"}, 0, 100.0, 8.0});
    policy::HoldCross policy({two_crossings()});
    traffic::BelievedGraph& belief = bench.scene.belief();
    const roads::Signal& signal = two_crossings().signal(two_crossings().find_signal("A").value());
    const auto asked = [&](char cross, float emergency_m) {
        belief.signals.state.assign(two_crossings().signals().size(),
                                    std::string(signal.links.size(), cross));
        for (auto* states : {&belief.vehicles, &belief.own_states}) {
            for (traffic::BelievedVehicle& vehicle : *states) {
                if (vehicle.key == emergency) vehicle.state.lane_position_m = emergency_m;
            }
        }
        std::vector<traffic::Lease> leases;
        policy.act(belief, leases);
        std::vector<core::VehicleKey> keys;
        for (const traffic::Lease& lease : leases) {
            EXPECT_TRUE(std::holds_alternative<traffic::StopAtLine>(lease.action));
            keys.push_back(std::get<core::VehicleKey>(lease.target));
        }
        return keys;
    };
    EXPECT_EQ(asked('G', 450.0F), std::vector{near}) << far.value << " is too far from its line";
    EXPECT_TRUE(asked('r', 450.0F).empty()) << "they stand anyway";
    EXPECT_TRUE(asked('G', 300.0F).empty()) << "16 s before the arrival";
}

}  // namespace
}  // namespace clearway::testing
