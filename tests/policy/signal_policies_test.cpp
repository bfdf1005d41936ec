#include <algorithm>

#include <gtest/gtest.h>

#include "policy/green_wave.hpp"
#include "policy/preempt_signals.hpp"
#include "policy/recover_signals.hpp"
#include "policy/red_privilege.hpp"
#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

std::vector<traffic::Lease> act(policy::Policy& policy, CrossingScene& scene, double time_s = 100.0,
                                const std::optional<std::string>& signals = std::nullopt) {
    traffic::BelievedGraph& belief = scene.belief(signals);
    belief.time = core::Seconds(time_s);
    std::vector<traffic::Lease> leases;
    policy.act(belief, leases);
    return leases;
}

CrossingScene emergency_at(double before_line_m, double speed_mps = 16.0,
                           const std::vector<std::string>& route = eastbound) {
    CrossingScene scene;
    scene.add({"e", VehicleClass::emergency, route, 1, line_m - before_line_m, speed_mps});
    return scene;
}

/// Comes from the west, 30 m before the first of two crossings.
CrossingScene emergency_in_the_square() {
    CrossingScene scene(100.0, short_square());
    scene.add({"e", VehicleClass::emergency, {"left0A0", "A0B0", "B0T"}, 0, 160.0, 10.0});
    return scene;
}

TEST(PreemptSignals, asks_eight_seconds_before_arrival_and_not_earlier) {
    policy::PreemptSignals policy({two_crossings()});
    CrossingScene far = emergency_at(130.0);
    EXPECT_TRUE(act(policy, far).empty());
    CrossingScene near = emergency_at(126.0);
    const auto leases = act(policy, near);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<core::SignalIndex>(leases[0].target), two_crossings().find_signal("A"));
    EXPECT_EQ(leases[0].beneficiary, core::vehicle_key("e"));
}

TEST(PreemptSignals, asks_two_seconds_earlier_for_each_vehicle_in_the_longest_queue_ahead) {
    policy::PreemptSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(180.0);
    scene.add({"h1", VehicleClass::human, eastbound, 1, 485.0, 0.0});
    scene.add({"h2", VehicleClass::human, eastbound, 0, 485.0, 0.0});
    EXPECT_TRUE(act(policy, scene).empty()) << "11.25 s away, lead 10 s: two queues of one";
    scene.add({"h3", VehicleClass::human, eastbound, 0, 477.0, 0.0});
    EXPECT_EQ(act(policy, scene).size(), 1U) << "lead 12 s";
}

TEST(PreemptSignals, keeps_asking_until_the_vehicle_has_passed) {
    policy::PreemptSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(180.0);
    for (int number = 0; number < 3; ++number)
        scene.add(
            {"h" + std::to_string(number), VehicleClass::human, eastbound, 1, 485.0 - 8.0 * number, 0.0});
    EXPECT_EQ(act(policy, scene).size(), 1U);
    for (int number = 0; number < 3; ++number)
        scene.remove(core::vehicle_key("h" + std::to_string(number)));
    EXPECT_EQ(act(policy, scene).size(), 1U) << "11.25 s away behind a queue that has just begun to move";
    policy::PreemptSignals fresh({two_crossings()});
    EXPECT_TRUE(act(fresh, scene).empty());
    scene.remove(core::vehicle_key("e"));
    EXPECT_TRUE(act(policy, scene).empty());
}

TEST(PreemptSignals, asks_for_the_whole_approach_and_nothing_else) {
    policy::PreemptSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(50.0);
    const auto leases = act(policy, scene);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<traffic::HoldGreen>(leases[0].action).links,
              (std::vector<std::uint16_t>{12, 13, 14, 15}));
}

TEST(PreemptSignals, tells_which_of_the_links_its_vehicle_takes) {
    policy::PreemptSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(50.0, 10.0, {"west_A", "A_north_a"});
    const auto leases = act(policy, scene);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<traffic::HoldGreen>(leases[0].action).own_links, (std::vector<std::uint16_t>{15}));
}

TEST(PreemptSignals, asks_for_as_long_as_two_decisions_take) {
    for (const double period_s : {0.5, 3.0}) {
        policy::PreemptSignals policy({two_crossings(), core::Seconds(period_s)});
        CrossingScene scene = emergency_at(50.0);
        const auto leases = act(policy, scene);
        ASSERT_EQ(leases.size(), 1U);
        EXPECT_DOUBLE_EQ(leases[0].expiry.value - 100.0, 2.0 * period_s);
    }
}

TEST(RedPrivilege, asks_again_before_its_lease_ends_however_seldom_it_decides) {
    for (const double period_s : {0.5, 3.0}) {
        policy::RedPrivilege policy({two_crossings(), core::Seconds(period_s)});
        CrossingScene scene = emergency_at(50.0);
        const auto leases = act(policy, scene);
        ASSERT_FALSE(leases.empty());
        EXPECT_DOUBLE_EQ(leases[0].expiry.value - 100.0, std::max(2.0, 2.0 * period_s));
    }
}

TEST(PreemptSignals, serves_a_left_turn_with_its_approach) {
    policy::PreemptSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(50.0, 10.0, {"west_A", "A_north_a"});
    const auto leases = act(policy, scene);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<traffic::HoldGreen>(leases[0].action).links,
              (std::vector<std::uint16_t>{12, 13, 14, 15}));
}

TEST(PreemptSignals, knows_the_emergency_vehicle_from_itself_when_no_sensor_saw_it) {
    policy::PreemptSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(50.0);
    scene.belief();
    traffic::BelievedGraph belief = scene.belief();
    belief.vehicles.clear();
    belief.first_link = {0};
    std::vector<traffic::Lease> leases;
    policy.act(belief, leases);
    EXPECT_EQ(leases.size(), 1U);
}

TEST(PreemptSignals, asks_for_no_green_into_a_full_block_of_a_closed_loop) {
    policy::PreemptSignals looks({short_square()}, {.exit_room_m = 8.0});
    policy::PreemptSignals anyway({short_square()}, {.exit_room_m = 0.0});
    policy::PreemptSignals long_enough({short_square()}, {.short_block_m = 80.0, .exit_room_m = 8.0});
    CrossingScene scene = emergency_in_the_square();
    CrossingScene moving = scene;
    scene.add({"last", VehicleClass::human, {"A0B0", "B0T"}, 0, 12.0, 0.0});
    EXPECT_TRUE(act(looks, scene).empty()) << "7 m behind a car of 5 m";
    EXPECT_EQ(act(anyway, scene).size(), 1U);
    EXPECT_EQ(act(long_enough, scene).size(), 1U) << "no block is shorter than 80 m";
    moving.add({"last", VehicleClass::human, {"A0B0", "B0T"}, 0, 12.0, 3.0});
    EXPECT_EQ(act(looks, moving).size(), 1U) << "who drives makes room";
    EXPECT_EQ(act(looks, scene).size(), 1U) << "a request once made stands until the vehicle has passed";
}

TEST(PreemptSignals, looks_at_no_room_where_no_loop_is_closed) {
    policy::PreemptSignals policy({two_crossings()}, {.short_block_m = 1000.0, .exit_room_m = 200.0});
    CrossingScene scene = emergency_at(50.0);
    for (const std::uint32_t lane : {0U, 1U})
        scene.add({"last" + std::to_string(lane), VehicleClass::human, {"A_B", "B_east"}, lane, 12.0, 0.0});
    EXPECT_EQ(act(policy, scene).size(), 1U);
}

TEST(PreemptSignals, holds_no_more_signals_of_a_closed_loop_than_it_may) {
    policy::PreemptSignals both({short_square()}, {.lead_s = 60.0, .signals_ahead = 0});
    policy::PreemptSignals next({short_square()}, {.lead_s = 60.0, .signals_ahead = 1});
    CrossingScene scene = emergency_in_the_square();
    EXPECT_EQ(act(both, scene).size(), 2U);
    const auto leases = act(next, scene);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<core::SignalIndex>(leases[0].target), short_square().find_signal("A0"));
    policy::PreemptSignals elsewhere({two_crossings()}, {.lead_s = 60.0, .signals_ahead = 1});
    CrossingScene chain = emergency_at(50.0);
    EXPECT_EQ(act(elsewhere, chain).size(), 2U);
}

TEST(RecoverSignals, counts_nobody_whose_way_is_full_where_it_looks_at_the_room) {
    policy::RecoverSignals looks({two_crossings()}, {.exit_room_m = 8.0});
    policy::RecoverSignals does_not({two_crossings()});
    CrossingScene scene = emergency_at(100.0, 16.0, {"west_A", "A_north_a"});
    scene.add({"h1", VehicleClass::human, eastbound, 0, 480.0, 0.0});
    EXPECT_EQ(act(looks, scene).size(), 1U);
    for (const std::uint32_t lane : {0U, 1U})
        for (const char* const exit : {"A_B", "A_south_a", "A_north_a"})
            scene.add({exit + std::to_string(lane), VehicleClass::human, {exit}, lane, 12.0, 0.0});
    EXPECT_TRUE(act(looks, scene).empty());
    EXPECT_EQ(act(does_not, scene).size(), 1U);
}

TEST(RecoverSignals, leaves_signals_of_a_closed_loop_of_short_blocks_their_cycle) {
    CrossingScene scene = emergency_in_the_square();
    scene.add({"h1", VehicleClass::human, {"bottom0A0", "A0A1"}, 0, 180.0, 0.0});
    policy::RecoverSignals short_blocks({short_square()});
    EXPECT_TRUE(act(short_blocks, scene).empty());
    policy::RecoverSignals anyway({short_square()}, {.short_block_m = 0.0});
    EXPECT_FALSE(act(anyway, scene).empty());
    policy::RecoverSignals long_enough({short_square()}, {.short_block_m = 80.0});
    EXPECT_FALSE(act(long_enough, scene).empty());
    CrossingScene chain = emergency_at(100.0);
    chain.add({"h1", VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 285.0, 0.0});
    policy::RecoverSignals no_loop({two_crossings()}, {.short_block_m = 1000.0});
    EXPECT_EQ(act(no_loop, chain).size(), 1U);
}

TEST(GreenWave, opens_each_signal_around_the_planned_arrival_whatever_happens) {
    policy::GreenWave policy({two_crossings()});
    CrossingScene scene = emergency_at(200.0);
    EXPECT_TRUE(act(policy, scene, 100.0).empty()) << "200 m at 16.67 m/s: 12 s, asked for 8 s before";
    const auto first = act(policy, scene, 104.5);
    ASSERT_EQ(first.size(), 1U);
    EXPECT_EQ(std::get<core::SignalIndex>(first[0].target), two_crossings().find_signal("A"));
    const auto second = act(policy, scene, 128.0);
    ASSERT_EQ(second.size(), 1U) << "it still stands where it was";
    EXPECT_EQ(std::get<core::SignalIndex>(second[0].target), two_crossings().find_signal("B"));
    EXPECT_TRUE(act(policy, scene, 150.0).empty());
}

TEST(RecoverSignals, favours_those_who_stand_where_the_next_green_serves_most) {
    policy::RecoverSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(100.0);
    EXPECT_TRUE(act(policy, scene).empty()) << "nobody waits";
    scene.add({"h1", VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 285.0, 0.0});
    scene.add({"h2", VehicleClass::human, {"B_A", "A_west"}, 0, 275.0, 0.0});
    scene.add({"h3", VehicleClass::human, {"south_a_A", "A_north_a"}, 1, 285.0, 0.0});
    const auto leases = act(policy, scene);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<traffic::AdjustGreen>(leases[0].action).links,
              (std::vector<std::uint16_t>{0, 1, 10, 11}));
}

TEST(RecoverSignals, goes_on_for_a_while_after_the_emergency_vehicle_has_passed) {
    policy::RecoverSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(10.0);
    scene.add({"h1", VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 285.0, 0.0});
    EXPECT_EQ(act(policy, scene, 100.0).size(), 1U);
    scene.remove(core::vehicle_key("e"));
    EXPECT_EQ(act(policy, scene, 159.0).size(), 1U);
    EXPECT_TRUE(act(policy, scene, 160.5).empty());
}

TEST(RecoverSignals, keeps_what_is_green_unless_a_change_serves_four_vehicles_more) {
    policy::RecoverSignals policy({two_crossings()});
    CrossingScene scene = emergency_at(100.0);
    // The first phase serves north and south: one vehicle comes near on green, others stand in the west.
    scene.add({"h0", VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 280.0, 10.0});
    for (int number = 1; number <= 5; ++number)
        scene.add(
            {"h" + std::to_string(number), VehicleClass::human, eastbound, 0, 490.0 - 8.0 * number, 0.0});
    const auto served = [&] {
        return std::get<traffic::AdjustGreen>(act(policy, scene).front().action).links;
    };
    EXPECT_EQ(served().front(), 0U) << "one and the worth of a change against five";
    scene.add({"h6", VehicleClass::human, eastbound, 0, 440.0, 0.0});
    EXPECT_GE(served().front(), 12U);
}

TEST(RedPrivilege, slows_the_emergency_vehicle_down_to_20_kmh_at_the_line) {
    policy::RedPrivilege policy({two_crossings()});
    const std::string red(16, 'r');
    const auto speed_at = [&](double before_line_m) -> std::optional<double> {
        CrossingScene scene = emergency_at(before_line_m);
        for (const traffic::Lease& lease : act(policy, scene, 100.0, red))
            if (const auto* drive = std::get_if<traffic::DriveAt>(&lease.action)) return drive->speed.value;
        return std::nullopt;
    };
    EXPECT_FALSE(speed_at(150.0).has_value()) << "far enough to brake later";
    EXPECT_NEAR(speed_at(30.0).value(), std::sqrt(5.56 * 5.56 + 2.0 * 2.0 * 30.0), 0.05);
    EXPECT_NEAR(speed_at(0.5).value(), 5.7, 0.1);
}

TEST(RedPrivilege, is_asked_for_before_red_and_not_before_green) {
    policy::RedPrivilege policy({two_crossings()});
    CrossingScene scene = emergency_at(100.0);
    ASSERT_EQ(act(policy, scene).size(), 1U) << "the first phase serves north and south";
    EXPECT_TRUE(act(policy, scene, 100.0, "rrrrGGGgrrrrGGGg").empty());
    CrossingScene far = emergency_at(250.0);
    EXPECT_TRUE(act(policy, far).empty());
}

}  // namespace
}  // namespace clearway::testing
