#include "sumo/session.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "sumo/detail/gateway.hpp"
#include "sumo/scene.hpp"

namespace clearway {
namespace {

using sumo::Session;
using test::key;
using test::Scene;
using test::step_until;
using test::vehicle;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::uint32_t row_of(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::uint32_t>(std::ranges::find(names, name) - names.begin());
}

TEST(Session, VehicleThatOvertakesOnTheOncomingLaneCountsAsOnItsOwn) {
    const Scene scene;
    const auto config = scene.config(scene.two_way_road(),
                                     vehicle("slow", "hv", 0, "east", R"(departPos="100" departSpeed="10")") +
                                         vehicle("fast", "ev", 1, "east", R"(departSpeed="20")"));
    Session session(config);
    session.step();
    const traffic::Command crawl = traffic::SetSpeed{key("slow"), core::MetresPerSecond(10.0)};
    session.apply(std::span(&crawl, 1));
    bool was_beside = false;
    float place_m = 0.0F;
    while (session.time().value < 60.0) {
        session.step();
        const auto row = session.snapshot().row_of(key("fast"));
        if (!row) continue;
        const truth::Snapshot& now = session.snapshot();
        was_beside = was_beside || now.y_m[*row] > 0.5F;
        ASSERT_EQ(config.names.lanes.at(now.lane[*row].value), "east_0");
        EXPECT_NEAR(now.lane_position_m[*row], now.x_m[*row], 0.5F);
        EXPECT_GE(now.lane_position_m[*row], place_m);
        EXPECT_EQ(now.route_edge[*row], 0U);
        place_m = now.lane_position_m[*row];
    }
    EXPECT_TRUE(was_beside) << "it did not overtake, so the test shows nothing";
}

/// What `sumo_test` reads itself is the oracle: every value of every vehicle, asked for anew.
TEST(Session, VehiclesThatRestAreReadAsIfAskedForEverything) {
    const Scene scene;
    std::string queue;
    for (int number = 0; number < 24; ++number)
        queue += vehicle("v" + std::to_string(number), number % 3 == 0 ? "av" : "hv", 2.0 * number,
                         number % 2 == 0 ? "west_in east_out" : "south_in north_out");
    Session session(scene.config(scene.crossing(), queue));
    const auto oracle = sumo::detail::gateway::in_this_process();
    std::size_t standing = 0;
    for (int step = 0; step < 400; ++step) {
        session.step();
        const truth::Snapshot& now = session.snapshot();
        for (core::VehicleIndex row = 0; row < now.size(); ++row) {
            sumo::detail::gateway::VehicleReading whole;
            const std::string& id = session.roster().find(now.key[row])->id;
            ASSERT_EQ(oracle->read(id, whole), sumo::detail::gateway::Presence::on_road);
            ASSERT_EQ(now.x_m[row], static_cast<float>(whole.x_m)) << id;
            ASSERT_EQ(now.y_m[row], static_cast<float>(whole.y_m)) << id;
            ASSERT_EQ(now.speed_mps[row], static_cast<float>(whole.speed_mps)) << id;
            ASSERT_EQ(now.acceleration_mps2[row], static_cast<float>(whole.acceleration_mps2)) << id;
            ASSERT_EQ(now.lane_position_m[row], static_cast<float>(whole.lane_position_m)) << id;
            ASSERT_EQ(std::cos(now.heading_rad[row]),
                      std::cos(static_cast<float>(
                          std::remainder(std::numbers::pi / 2.0 - whole.angle_deg * std::numbers::pi / 180.0,
                                         2.0 * std::numbers::pi))))
                << id;
            standing += now.speed_mps[row] == 0.0F ? 1 : 0;
        }
    }
    EXPECT_GT(standing, 500U) << "they hardly stand, so the test shows nothing";
}

TEST(Session, VehiclesDepartDriveAndArrive) {
    const Scene scene;
    Session session(
        scene.config(scene.straight_road(), vehicle("a", "hv", 2, "in out") + vehicle("b", "hv", 10, "in")));
    EXPECT_EQ(session.time().value, 0.0);
    EXPECT_EQ(session.snapshot().size(), 0U);
    EXPECT_EQ(session.expected_vehicles(), 2);
    std::vector<std::pair<std::string, double>> log;
    while (session.expected_vehicles() > 0) {
        session.step();
        for (const core::VehicleKey k : session.events().departed) {
            log.emplace_back("+" + session.roster().find(k)->id, session.time().value);
        }
        for (const core::VehicleKey k : session.events().arrived) {
            EXPECT_FALSE(session.snapshot().row_of(k));
            log.emplace_back("-" + session.roster().find(k)->id, 0.0);
        }
        EXPECT_THAT(session.events().removed, IsEmpty());
    }
    ASSERT_EQ(log.size(), 4U);
    EXPECT_EQ(log[0], (std::pair<std::string, double>{"+a", 2.25}));
    EXPECT_EQ(log[1], (std::pair<std::string, double>{"+b", 10.25}));
    EXPECT_EQ(log[2].first, "-b");
    EXPECT_EQ(log[3].first, "-a");
}

TEST(Session, RowsAreOrderedByKeyAndFoundByIt) {
    const Scene scene;
    std::string vehicles;
    for (int i = 0; i < 20; ++i) {
        vehicles +=
            vehicle("v" + std::to_string(i), "hv", i, "in out", R"(departLane="best" departSpeed="10")");
    }
    Session session(scene.config(scene.straight_road(), vehicles));
    step_until(session, 25.0);
    const truth::Snapshot& now = session.snapshot();
    ASSERT_EQ(now.size(), 20U);
    EXPECT_TRUE(std::ranges::is_sorted(now.key));
    for (std::size_t i = 1; i < 20; ++i) {
        const auto earlier = now.row_of(key("v" + std::to_string(i - 1)));
        const auto later = now.row_of(key("v" + std::to_string(i)));
        ASSERT_TRUE(earlier && later);
        EXPECT_GT(now.x_m[*earlier], now.x_m[*later]) << i;
    }
}

TEST(Session, ReadsPlaceSpeedAndLaneOfTheFrontBumper) {
    const Scene scene;
    const auto config =
        scene.config(scene.straight_road(),
                     vehicle("a", "hv", 0, "in out", R"(departPos="100" departSpeed="13" departLane="1")"));
    Session session(config);
    session.step();
    const truth::Snapshot& now = session.snapshot();
    ASSERT_EQ(now.size(), 1U);
    EXPECT_NEAR(now.lane_position_m[0], 100.0F, 1e-4F);
    EXPECT_NEAR(now.x_m[0], 100.0F, 1e-3F);
    EXPECT_NEAR(now.y_m[0], -1.6F, 1e-3F);  // left of two lanes of 3.2 m, right of the centre line
    EXPECT_NEAR(now.heading_rad[0], 0.0F, 1e-5F);
    EXPECT_FLOAT_EQ(now.speed_mps[0], 13.0F);
    EXPECT_EQ(now.lane[0].value, row_of(config.names.lanes, "in_1"));
    EXPECT_EQ(now.route_edge[0], 0U);
    step_until(session, 40.0);
    EXPECT_EQ(now.route_edge[0], 1U);
    EXPECT_GT(now.x_m[0], 500.0F);
}

TEST(Session, HeadingIsCounterClockwiseFromEast) {
    const Scene scene;
    Session session(scene.config(
        scene.crossing(), vehicle("east", "hv", 0, "west_in") + vehicle("north", "hv", 0, "south_in") +
                              vehicle("south", "hv", 0, "north_in") + vehicle("west", "hv", 0, "east_in")));
    session.step();
    const auto heading = [&](const char* id) {
        return session.snapshot().heading_rad[*session.snapshot().row_of(key(id))];
    };
    constexpr auto pi = std::numbers::pi_v<float>;
    EXPECT_NEAR(heading("east"), 0.0F, 1e-5F);
    EXPECT_NEAR(heading("north"), pi / 2, 1e-5F);
    EXPECT_NEAR(heading("south"), -pi / 2, 1e-5F);
    EXPECT_NEAR(std::abs(heading("west")), pi, 1e-5F);
}

TEST(Session, RosterKnowsClassKindSizeAndRoute) {
    const Scene scene;
    const auto config =
        scene.config(scene.straight_road(), vehicle("h", "hv", 0, "in out") + vehicle("a", "av", 5, "out"));
    Session session(config);
    step_until(session, 6.0);
    const traffic::VehicleInfo* human = session.roster().find(key("h"));
    const traffic::VehicleInfo* automated = session.roster().find(key("a"));
    ASSERT_TRUE(human != nullptr && automated != nullptr);
    EXPECT_EQ(human->vehicle_class, traffic::VehicleClass::human);
    EXPECT_EQ(human->kind, traffic::VehicleKind::other);
    EXPECT_FLOAT_EQ(human->length_m, 5.0F);
    EXPECT_FLOAT_EQ(human->width_m, 1.8F);
    EXPECT_FLOAT_EQ(human->minimum_gap_m, 2.5F);
    EXPECT_FLOAT_EQ(human->maximum_speed_mps, 50.0F);
    EXPECT_FLOAT_EQ(human->acceleration_mps2, 2.6F);
    EXPECT_FLOAT_EQ(human->deceleration_mps2, 4.5F);
    EXPECT_THAT(session.roster().route(human->route),
                ElementsAre(core::EdgeIndex{row_of(config.names.edges, "in")},
                            core::EdgeIndex{row_of(config.names.edges, "out")}));
    EXPECT_EQ(automated->vehicle_class, traffic::VehicleClass::automated);
    EXPECT_EQ(automated->kind, traffic::VehicleKind::van);
    EXPECT_FLOAT_EQ(automated->speed_factor, 1.1F);
}

TEST(Session, AddsAnEmergencyVehicleThatDepartsLater) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), ""));
    step_until(session, 5.0);
    session.add({.id = "fire",
                 .type = "hv",
                 .kind = traffic::VehicleKind::fire_engine,
                 .edges = {"in", "out"},
                 .depart = core::Seconds(8.0)});
    step_until(session, 8.0);
    EXPECT_EQ(session.roster().find(key("fire")), nullptr);
    EXPECT_EQ(session.expected_vehicles(), 1);
    session.step();
    EXPECT_THAT(session.events().departed, ElementsAre(key("fire")));
    EXPECT_EQ(session.roster().find(key("fire"))->vehicle_class, traffic::VehicleClass::emergency);
    EXPECT_EQ(session.roster().find(key("fire"))->kind, traffic::VehicleKind::fire_engine);
    EXPECT_EQ(session.snapshot().vehicle_class[0], traffic::VehicleClass::emergency);
}

TEST(Session, RefusesAnEmergencyVehicleThatCannotBeAndNamesEveryReason) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), ""));
    step_until(session, 5.0);
    try {
        session.add({.id = "late", .type = "none", .edges = {"in", "nowhere"}, .depart = core::Seconds(4.0)});
        FAIL() << "was accepted";
    } catch (const core::InputError& error) {
        EXPECT_EQ(error.problems().size(), 3U) << error.what();
        EXPECT_THAT(error.what(), HasSubstr("in the past"));
        EXPECT_THAT(error.what(), HasSubstr("'none'"));
        EXPECT_THAT(error.what(), HasSubstr("'nowhere'"));
    }
    session.step();
    EXPECT_EQ(session.expected_vehicles(), 0);
}

class StepLength : public ::testing::TestWithParam<double> {};

TEST_P(StepLength, ScalesTimeAndAcceleration) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), vehicle("a", "hv", 0, "in out", R"(departSpeed="0")"));
    config.step_length = core::Seconds(GetParam());
    config.begin = core::Seconds(100.0);
    config.route_files = {scene.routes(vehicle("a", "hv", 100, "in out", R"(departSpeed="0")"))};
    Session session(config);
    session.step();
    EXPECT_NEAR(session.time().value, 100.0 + GetParam(), 1e-9);
    float former_mps = session.snapshot().speed_mps[0];
    float former_m = session.snapshot().lane_position_m[0];
    for (int i = 0; i < 5; ++i) {
        session.step();
        const truth::Snapshot& now = session.snapshot();
        const auto step_s = static_cast<float>(GetParam());
        EXPECT_NEAR(now.acceleration_mps2[0] * step_s, now.speed_mps[0] - former_mps, 1e-4F);
        EXPECT_NEAR(now.lane_position_m[0] - former_m, now.speed_mps[0] * step_s, 1e-3F);
        former_mps = now.speed_mps[0];
        former_m = now.lane_position_m[0];
    }
    EXPECT_GT(former_mps, 0.0F);
}

INSTANTIATE_TEST_SUITE_P(Steps, StepLength, ::testing::Values(0.1, 0.25, 1.0));

TEST(Session, CloseLeavesCompleteTripsOfArrivedRunningAndWaitingVehicles) {
    const Scene scene;
    const auto config = scene.config(
        scene.straight_road(),
        vehicle("done", "hv", 0, "in") +
            vehicle("driving", "hv", 55, "in out", R"(departLane="0" departPos="6" departSpeed="0")") +
            vehicle("blocked", "hv", 60, "in out", R"(departLane="0")") +
            vehicle("later", "hv", 900, "in out"));
    Session session(config);
    step_until(session, 55.25);
    const traffic::Command hold = traffic::SetSpeed{key("driving"), core::MetresPerSecond(0.0)};
    session.apply(std::span(&hold, 1));
    session.add({.id = "waiting",
                 .type = "ev",
                 .edges = {"in", "out"},
                 .depart = core::Seconds(61.0),
                 .depart_lane = "0"});
    step_until(session, 65.0);
    session.close();
    session.close();
    const std::string trips = core::read_file(config.folder / "tripinfo.xml");
    for (const char* id : {"done", "driving", "blocked", "waiting"}) {
        EXPECT_THAT(trips, HasSubstr(std::string("tripinfo id=\"") + id + "\"")) << id;
    }
    EXPECT_THAT(trips, Not(HasSubstr("later"))) << "its time to depart had not come";
    EXPECT_THAT(trips, HasSubstr("</tripinfos>"));
}

TEST(Session, ClosedSessionMakesRoomForAnother) {
    const Scene scene;
    const auto config = scene.config(scene.straight_road(), vehicle("a", "hv", 0, "in"));
    {
        Session first(config);
        step_until(first, 3.0);
        EXPECT_THROW(Session{config}, std::logic_error);
        first.close();
        EXPECT_THROW(first.step(), std::logic_error);
    }
    Session second(config);
    second.step();
    EXPECT_THAT(second.events().departed, ElementsAre(key("a")));
}

TEST(Session, KnowsWhatAVehicleKnowsOfItself) {
    const Scene scene;
    Session session(scene.config(
        scene.straight_road(),
        vehicle("a", "av", 0, "in out", R"(departPos="100" departLane="0" departSpeed="10")") +
            vehicle("beside", "hv", 0, "in out", R"(departPos="100" departLane="1" departSpeed="10")") +
            vehicle("free", "hv", 0, "in out", R"(departPos="300" departLane="0" departSpeed="10")")));
    step_until(session, 1.0);
    EXPECT_EQ(session.could_change_lane(key("a"), truth::Neighbour::higher), std::optional(false));
    EXPECT_EQ(session.could_change_lane(key("a"), truth::Neighbour::lower), std::optional(false));
    EXPECT_EQ(session.could_change_lane(key("free"), truth::Neighbour::higher), std::optional(true));
    EXPECT_EQ(session.could_change_lane(key("nobody"), truth::Neighbour::higher), std::nullopt);
    const auto outlook = session.lane_outlook(key("free"));
    ASSERT_TRUE(outlook);
    ASSERT_EQ(outlook->size(), 2U);
    EXPECT_EQ((*outlook)[1].lane_number, 1U);
    EXPECT_EQ((*outlook)[1].best_offset, 0);
    EXPECT_NEAR((*outlook)[0].drivable_m,
                1000.0F - session.snapshot().x_m[*session.snapshot().row_of(key("free"))], 1.0F);
    EXPECT_NEAR(session.allowed_speed(key("a"))->value, 1.1 * 13.89, 1e-6);
    EXPECT_EQ(session.allowed_speed(key("nobody")), std::nullopt);
    EXPECT_EQ(session.lane_outlook(key("nobody")), std::nullopt);
}

TEST(Session, OptionsOfTheUserReplaceDefaults) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), vehicle("a", "hv", 0, "in"));
    config.extra_arguments = {"--collision.mingap-factor", "0.5", "--vehroute-output",
                              (scene.folder() / "run" / "routes.xml").string()};
    Session session(config);
    step_until(session, 60.0);
    session.close();
    EXPECT_THAT(core::read_file(config.folder / "routes.xml"), HasSubstr("</routes>"));
    EXPECT_THAT(core::read_file(config.folder / "tripinfo.xml"),
                HasSubstr("<collision.mingap-factor value=\"0.5\"/>"));
}

TEST(Session, UnsortedRouteFilesLoseNobody) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(),
                                 vehicle("late", "hv", 20, "in") + vehicle("early", "hv", 1, "in")));
    step_until(session, 22.0);
    EXPECT_EQ(session.roster().vehicles().size(), 2U);
}

TEST(Session, StatesTheVersionOfTheLibrary) {
    EXPECT_THAT(sumo::version(), Not(HasSubstr("SUMO")));
    EXPECT_THAT(sumo::version(), HasSubstr("."));
}

}  // namespace
}  // namespace clearway
