#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "sumo/scene.hpp"
#include "sumo/session.hpp"

namespace clearway {
namespace {

using sumo::Session;
using test::apply;
using test::key;
using test::Scene;
using test::vehicle;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

/// A vehicle that stands on the right lane at 300 m, and one that comes from behind.
std::string follower_and_obstacle() {
    return vehicle("ahead", "hv", 0, "in out", R"(departPos="280" departLane="0" departSpeed="0")") +
           vehicle("behind", "ev", 0, "in out", R"(departPos="100" departLane="0" departSpeed="10")");
}

void hold_obstacle(Session& session) {
    session.step();
    apply(session, traffic::SetSpeed{key("ahead"), core::MetresPerSecond(0.0)});
    apply(session, traffic::SetLaneChangeFreedom{key("ahead"), traffic::LaneChangeFreedom::none});
    apply(session, traffic::SetLaneChangeFreedom{key("behind"), traffic::LaneChangeFreedom::none});
}

TEST(Events, LastingContactIsOneCollisionAndKnowsTheEmergencyVehicle) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), follower_and_obstacle()));
    hold_obstacle(session);
    apply(session, traffic::SetSafetyChecks{key("behind"), traffic::SafetyChecks::off});
    apply(session, traffic::SetSpeed{key("behind"), core::MetresPerSecond(4.0)});
    std::vector<truth::Collision> collisions;
    while (session.time().value < 46.0) {
        session.step();
        for (const auto& collision : session.events().collisions)
            collisions.push_back(collision);
    }
    ASSERT_EQ(collisions.size(), 1U);
    EXPECT_EQ(collisions[0].collider, key("behind"));
    EXPECT_EQ(collisions[0].victim, key("ahead"));
    EXPECT_EQ(collisions[0].place, truth::CollisionPlace::lane);
    EXPECT_TRUE(collisions[0].with_emergency_vehicle);
    EXPECT_TRUE(session.snapshot().row_of(key("behind"))) << "a collision takes nobody off the road";
}

TEST(Events, WithSafetyChecksNothingCollides) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), follower_and_obstacle()));
    hold_obstacle(session);
    while (session.time().value < 46.0) {
        session.step();
        EXPECT_THAT(session.events().collisions, IsEmpty());
    }
    const truth::Snapshot& now = session.snapshot();
    EXPECT_EQ(now.speed_mps[*now.row_of(key("behind"))], 0.0F);
}

TEST(Events, CollisionsInsideJunctionsAreSeen) {
    const Scene scene;
    auto config = scene.config(
        scene.crossing(),
        vehicle("x", "hv", 0, "west_in east_out", R"(departPos="100" departLane="1" departSpeed="10")") +
            vehicle("y", "hv", 0, "south_in north_out",
                    R"(departPos="100" departLane="1" departSpeed="10")"));
    Session session(config);
    session.step();
    for (const char* id : {"x", "y"}) {
        apply(session, traffic::SetSafetyChecks{key(id), traffic::SafetyChecks::off});
        apply(session, traffic::SetSpeed{key(id), core::MetresPerSecond(10.0)});
    }
    std::vector<truth::Collision> collisions;
    while (session.time().value < 20.0) {
        session.step();
        for (const auto& collision : session.events().collisions)
            collisions.push_back(collision);
    }
    ASSERT_EQ(collisions.size(), 1U);
    EXPECT_EQ(collisions[0].place, truth::CollisionPlace::junction);
    EXPECT_FALSE(collisions[0].with_emergency_vehicle);
    EXPECT_TRUE(config.names.lanes.at(collisions[0].lane.value).starts_with(':'));
}

TEST(Events, TeleportedVehicleIsOffTheRoadUntilItIsBack) {
    const Scene scene;
    const std::string wall = R"(departPos="498" departSpeed="0" departLane=)";
    auto config = scene.config(
        scene.straight_road(),
        vehicle("ahead", "hv", 0, "in out", R"(departPos="280" departLane="0" departSpeed="0")") +
            vehicle("wall0", "wall", 0, "out", wall + "\"0\"") +
            vehicle("wall1", "wall", 0, "out", wall + "\"1\""));
    config.additional_files.push_back(
        scene.write("wall.add.xml", R"(<additional><vType id="wall" length="497.5"/></additional>)"));
    config.time_to_teleport = core::Seconds(10.0);
    Session session(config);
    session.step();
    apply(session, traffic::SetSpeed{key("ahead"), core::MetresPerSecond(0.0)});
    for (const char* id : {"wall0", "wall1"}) {
        apply(session, traffic::StopOnLane{key(id), core::Metres(499.0), core::Seconds(15.0)});
    }
    double started_s = 0.0;
    double back_s = 0.0;
    while (session.expected_vehicles() > 0) {
        session.step();
        for (const core::VehicleKey vehicle : session.events().teleported) {
            EXPECT_EQ(vehicle, key("ahead"));
            EXPECT_EQ(started_s, 0.0) << "one teleport only";
            started_s = session.time().value;
            apply(session, traffic::ReleaseSpeed{vehicle});
            apply(session, traffic::RequestLane{vehicle, 0, core::Seconds(1.0)});
        }
        const bool on_road = session.snapshot().row_of(key("ahead")).has_value();
        EXPECT_EQ(session.allowed_speed(key("ahead")).has_value(), on_road);
        if (started_s > 0.0 && on_road && back_s == 0.0) back_s = session.time().value;
        EXPECT_THAT(session.events().removed, IsEmpty());
    }
    EXPECT_NEAR(started_s, 10.0, 1.0);
    EXPECT_GT(back_s, 15.0);
    EXPECT_EQ(session.skipped_commands(), 1U) << "of a vehicle off the road only the lane request";
}

TEST(Events, EmergencyBrakingAgreesWithSumosOwnWarnings) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), follower_and_obstacle());
    config.step_length = core::Seconds(0.5);
    Session session(config);
    session.step();
    apply(session, traffic::SetSpeed{key("ahead"), core::MetresPerSecond(0.0)});
    apply(session, traffic::SetLaneChangeFreedom{key("ahead"), traffic::LaneChangeFreedom::none});
    apply(session, traffic::SetLaneChangeFreedom{key("behind"), traffic::LaneChangeFreedom::none});
    // Safety off until the vehicle is far too near to brake as usual, then on again.
    apply(session, traffic::SetSafetyChecks{key("behind"), traffic::SafetyChecks::off});
    apply(session, traffic::SetSpeed{key("behind"), core::MetresPerSecond(20.0)});
    std::size_t brakings = 0;
    bool released = false;
    while (session.time().value < 40.0) {
        const auto row = session.snapshot().row_of(key("behind"));
        if (!released && session.snapshot().x_m[*row] > 255.0F) {
            released = true;
            apply(session, traffic::ReleaseSpeed{key("behind")});
            apply(session, traffic::SetSafetyChecks{key("behind"), traffic::SafetyChecks::on});
        }
        session.step();
        for (const truth::EmergencyBraking& braking : session.events().emergency_brakings) {
            EXPECT_EQ(braking.vehicle, key("behind"));
            EXPECT_GE(braking.deceleration_mps2, 9.0F);
            ++brakings;
        }
    }
    EXPECT_TRUE(released);
    EXPECT_EQ(brakings, 1U);
    EXPECT_EQ(count(core::read_file(config.folder / "sumo.log"), "emergency braking"), 1U);
}

TEST(Events, VehicleTakenOutUnderWayWasRemoved) {
    const Scene scene;
    auto config = scene.config(
        scene.straight_road(),
        vehicle("a", "hv", 0, "in out", R"(departPos="280" departLane="0" departSpeed="0")") +
            vehicle("b", "hv", 0, "in out", R"(departPos="100" departLane="0" departSpeed="13")"));
    config.extra_arguments = {"--collision.action", "remove"};
    Session session(config);
    session.step();
    apply(session, traffic::SetSpeed{key("a"), core::MetresPerSecond(0.0)});
    apply(session, traffic::SetSafetyChecks{key("b"), traffic::SafetyChecks::off});
    apply(session, traffic::SetSpeed{key("b"), core::MetresPerSecond(13.0)});
    std::set<core::VehicleKey> removed;
    while (session.expected_vehicles() > 0) {
        session.step();
        EXPECT_THAT(session.events().arrived, IsEmpty());
        removed.insert(session.events().removed.begin(), session.events().removed.end());
        for (const core::VehicleKey vehicle : removed)
            EXPECT_FALSE(session.snapshot().row_of(vehicle));
        if (session.time().value > 100.0) break;
    }
    EXPECT_EQ(removed, (std::set{key("a"), key("b")}));
}

TEST(Events, RouteTakenUnderWayIsNoticedWithinASecond) {
    const Scene scene;
    auto config =
        scene.config(scene.crossing(), vehicle("a", "hv", 0, "west_in east_out", R"(departSpeed="0")"));
    config.additional_files.push_back(scene.write(
        "rerouter.add.xml", R"(<additional><rerouter id="r" edges="west_in"><interval begin="0" end="1000">)"
                            R"(<destProbReroute id="north_out"/></interval></rerouter></additional>)"));
    Session session(config);
    test::step_until(session, 2.5);
    const traffic::VehicleInfo* info = session.roster().find(key("a"));
    ASSERT_NE(info, nullptr);
    std::vector<std::string> edges;
    for (const core::EdgeIndex edge : session.roster().route(info->route)) {
        edges.push_back(test::read_names(config.network).edges.at(edge.value));
    }
    EXPECT_THAT(edges, ElementsAre("west_in", "north_out"));
}

TEST(Events, AParkedVehicleLeavesTheSnapshotAndComesBack) {
    const Scene scene;
    Session session(scene.config(
        scene.straight_road(), R"(<vehicle id="bus" type="hv" depart="0"><route edges="in out"/>)"
                               R"(<stop lane="in_0" endPos="200" duration="10" parking="true"/></vehicle>)"));
    int away = 0;
    int back = 0;
    std::size_t arrived = 0;
    while (session.time().value < 150.0 && arrived == 0) {
        session.step();
        const bool on_road = session.snapshot().row_of(key("bus")).has_value();
        if (!on_road && session.time().value > 5.0) ++away;
        if (on_road && away > 0) ++back;
        arrived += session.events().arrived.size();
    }
    EXPECT_EQ(arrived, 1U);
    EXPECT_NEAR(away * 0.25, 10.0, 2.0);
    EXPECT_GT(back, 0);
}

}  // namespace
}  // namespace clearway
