#include <algorithm>

#include <gtest/gtest.h>

#include "sumo/scene.hpp"
#include "sumo/session.hpp"

namespace clearway {
namespace {

using sumo::Session;
using sumo::SessionConfig;
using test::key;
using test::Scene;
using test::step_until;
using test::vehicle;

constexpr const char* first_obstacle = "clearway.incident.0.0";

/// Lane of the straight road by its id.
core::LaneIndex lane_of(const SessionConfig& config, const std::string& id) {
    const auto found = std::ranges::find(config.names.lanes, id);
    return core::LaneIndex{static_cast<std::uint32_t>(found - config.names.lanes.begin())};
}

/// Vehicles on the outer lane of `in`, one each four seconds, which stay there.
std::string column_of(int count) {
    std::string vehicles;
    for (int number = 0; number < count; ++number)
        vehicles += vehicle("v" + std::to_string(number), "hv", 4.0 * number, "in out",
                            R"(departSpeed="10" departLane="0")");
    return vehicles;
}

float stands_at_m(const Session& session, const char* id) {
    return session.snapshot().lane_position_m[session.snapshot().row_of(key(id)).value()];
}

TEST(Obstacle, others_stop_behind_it_and_drive_on_when_it_is_gone) {
    const Scene scene;
    const SessionConfig config = scene.config(scene.straight_road(), column_of(1));
    Session session(config);
    for (int number = 0; number < 2; ++number)
        session.add_obstacle("clearway.incident.0." + std::to_string(number),
                             lane_of(config, "in_" + std::to_string(number)), core::Metres(300.0));
    step_until(session, 90.0);
    ASSERT_TRUE(session.has_obstacle(first_obstacle));
    ASSERT_EQ(session.snapshot().size(), 1U);
    EXPECT_LT(stands_at_m(session, "v0"), 295.0F);  // an obstacle is 5 m long
    EXPECT_GT(stands_at_m(session, "v0"), 250.0F);
    EXPECT_EQ(session.expected_vehicles(), 1);
    EXPECT_EQ(session.roster().vehicles().size(), 1U);
    session.remove_obstacle(first_obstacle);
    session.remove_obstacle("clearway.incident.0.1");
    step_until(session, 92.0);
    EXPECT_FALSE(session.has_obstacle(first_obstacle));
    EXPECT_EQ(session.expected_vehicles(), 1);
    step_until(session, 180.0);
    EXPECT_EQ(session.expected_vehicles(), 0);
    EXPECT_TRUE(session.events().collisions.empty());
}

TEST(Obstacle, is_no_event_and_waits_until_there_is_room) {
    const Scene scene;
    const SessionConfig config = scene.config(scene.straight_road(), column_of(12));
    Session session(config);
    step_until(session, 20.0);
    // Right ahead of a vehicle that could not brake in time.
    const float taken_m = stands_at_m(session, "v1") + 12.0F;
    session.add_obstacle(first_obstacle, lane_of(config, "in_0"), core::Metres(taken_m));
    std::size_t entered = session.roster().vehicles().size();
    double entered_s = 0.0;
    while (session.time().value < 80.0) {
        session.step();
        entered += session.events().departed.size();
        EXPECT_TRUE(session.events().removed.empty());
        EXPECT_TRUE(session.events().collisions.empty());
        if (entered_s == 0.0 && session.has_obstacle(first_obstacle)) entered_s = session.time().value;
    }
    EXPECT_GT(entered_s, 20.5);
    EXPECT_EQ(entered, 12U);
}

TEST(Obstacle, one_that_found_no_room_can_be_taken_back) {
    const Scene scene;
    const SessionConfig config = scene.config(scene.straight_road(), column_of(1));
    Session session(config);
    step_until(session, 10.0);
    session.add_obstacle(first_obstacle, lane_of(config, "in_0"), core::Metres(stands_at_m(session, "v0")));
    session.remove_obstacle(first_obstacle);
    step_until(session, 20.0);
    EXPECT_FALSE(session.has_obstacle(first_obstacle));
    EXPECT_EQ(session.expected_vehicles(), 1);
    step_until(session, 120.0);
    EXPECT_EQ(session.expected_vehicles(), 0);
}

TEST(Obstacle, a_lane_closed_to_others_lets_emergency_vehicles_pass_and_opens_again) {
    const Scene scene;
    SessionConfig config =
        scene.config(scene.straight_road(), vehicle("hv", "hv", 0, "in out", R"(departSpeed="10")") +
                                                vehicle("ev", "ev", 1, "in out", R"(departSpeed="10")"));
    config.extra_arguments = {"--ignore-route-errors", "true"};
    Session session(config);
    session.close_to_others(lane_of(config, "out_0"));
    session.close_to_others(lane_of(config, "out_1"));
    step_until(session, 100.0);
    EXPECT_FALSE(session.snapshot().row_of(key("ev")));
    ASSERT_TRUE(session.snapshot().row_of(key("hv")));
    EXPECT_LT(session.snapshot().x_m[*session.snapshot().row_of(key("hv"))], 505.0F);
    session.open_again(lane_of(config, "out_0"));
    session.open_again(lane_of(config, "out_1"));
    step_until(session, 200.0);
    EXPECT_EQ(session.expected_vehicles(), 0);
}

TEST(Obstacle, a_limit_on_a_lane_holds_until_it_is_taken_back) {
    const Scene scene;
    const SessionConfig config = scene.config(scene.straight_road(), column_of(1));
    Session session(config);
    step_until(session, 2.0);  // SUMO refuses to let a vehicle enter faster than the limit
    for (const char* const id : {"in_0", "in_1"})
        session.limit(lane_of(config, id), core::MetresPerSecond(5.0));
    step_until(session, 20.0);
    const auto speed = [&] { return session.snapshot().speed_mps[0]; };
    EXPECT_LE(speed(), 6.5F);
    for (const char* const id : {"in_0", "in_1"})
        session.limit(lane_of(config, id), std::nullopt);
    step_until(session, 35.0);
    EXPECT_GT(speed(), 10.0F);
    // No limit is raised.
    session.limit(lane_of(config, "in_0"), core::MetresPerSecond(50.0));
    EXPECT_LT(session.allowed_speed(key("v0")).value().value, 20.0);
}

}  // namespace
}  // namespace clearway
