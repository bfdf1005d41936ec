#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "sumo/scene.hpp"
#include "sumo/session.hpp"

namespace clearway {
namespace {

using sumo::Session;
using test::apply;
using test::key;
using test::Scene;
using test::step_until;
using test::vehicle;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

float speed(const Session& session, const char* id) {
    return session.snapshot().speed_mps[session.snapshot().row_of(key(id)).value()];
}

float place(const Session& session, const char* id) {
    return session.snapshot().x_m[session.snapshot().row_of(key(id)).value()];
}

float across(const Session& session, const char* id) {
    return session.snapshot().y_m[session.snapshot().row_of(key(id)).value()];
}

/// Alone on the straight road at 10 m/s.
std::string one_vehicle() {
    return vehicle("a", "hv", 0, "in out", R"(departSpeed="10" departLane="0")");
}

TEST(Commands, WhatSumoWouldSwallowThrows) {
    const Scene scene;
    Session session(
        scene.config(scene.crossing(), vehicle("a", "hv", 0, "west_in east_out", R"(departSpeed="10")")));
    session.step();
    const core::VehicleKey a = key("a");
    const core::SignalIndex c{0};
    const std::size_t links = session.snapshot().signals.state.at(0).size();
    const std::vector<traffic::Command> illegal = {
        traffic::SetSpeed{a, core::MetresPerSecond(not_a_number)},
        traffic::SetSpeed{a, core::MetresPerSecond(infinity)},
        traffic::SetSpeed{a, core::MetresPerSecond(-1.0)},
        traffic::RequestLane{a, 9, core::Seconds(2.0)},
        traffic::RequestLane{a, static_cast<std::uint32_t>(-3), core::Seconds(2.0)},
        traffic::RequestLane{a, 1, core::Seconds(0.0)},
        traffic::RequestLane{a, 1, core::Seconds(not_a_number)},
        traffic::StopOnLane{a, core::Metres(-5.0), core::Seconds(2.0)},
        traffic::StopOnLane{a, core::Metres(not_a_number), core::Seconds(2.0)},
        traffic::StopOnLane{a, core::Metres(5000.0), core::Seconds(2.0)},
        traffic::StopOnLane{a, core::Metres(100.0), core::Seconds(infinity)},
        traffic::SetLateralAlignment{a, traffic::LateralAlignment::right},
        traffic::SteerSideways{a, core::Metres(1.0)},
        traffic::SetSignalState{c, std::string(links - 1, 'r')},
        traffic::SetSignalState{c, std::string(links + 1, 'r')},
        traffic::SetSignalState{c, std::string(links, 'x')},
        traffic::SetSignalState{c, std::string(links, 'R')},
        traffic::SetSignalState{core::SignalIndex{1}, std::string(links, 'r')},
        traffic::SetSignalState{core::SignalIndex::none(), std::string(links, 'r')},
        traffic::RestoreProgram{c, 99},
    };
    for (std::size_t i = 0; i < illegal.size(); ++i) {
        EXPECT_THROW(apply(session, illegal[i]), std::invalid_argument) << "command " << i;
    }
    session.step();
    EXPECT_GT(speed(session, "a"), 10.0F) << "an illegal command was carried out";
    EXPECT_EQ(session.skipped_commands(), 0U);
}

TEST(Commands, ForVehiclesThatLeftAreSkippedAndCounted) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), vehicle("a", "hv", 0, "in")));
    step_until(session, 60.0);
    ASSERT_FALSE(session.snapshot().row_of(key("a")));
    apply(session, traffic::SetSpeed{key("a"), core::MetresPerSecond(3.0)});
    apply(session, traffic::RequestLane{key("a"), 7, core::Seconds(1.0)});
    apply(session, traffic::ReleaseSpeed{key("never seen")});
    EXPECT_EQ(session.skipped_commands(), 3U);
}

TEST(Commands, SpeedIsHeldAndGivenBack) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), one_vehicle()));
    step_until(session, 1.0);
    apply(session, traffic::SetSpeed{key("a"), core::MetresPerSecond(4.0)});
    step_until(session, 10.0);
    EXPECT_FLOAT_EQ(speed(session, "a"), 4.0F);
    apply(session, traffic::ReleaseSpeed{key("a")});
    step_until(session, 25.0);
    EXPECT_NEAR(speed(session, "a"), 13.89F, 0.01F);
}

TEST(Commands, LaneIsHeldForItsDurationOrUntilReleased) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), one_vehicle()));
    step_until(session, 1.0);
    const float right_lane_m = across(session, "a");
    apply(session, traffic::RequestLane{key("a"), 1, core::Seconds(12.0)});
    step_until(session, 12.0);
    EXPECT_NEAR(across(session, "a"), right_lane_m + 3.2F, 0.1F)
        << "keeps left although the right lane is free";
    apply(session, traffic::ReleaseLane{key("a")});
    apply(session, traffic::RequestLane{key("a"), 1, core::Seconds(1000.0)});
    apply(session, traffic::ReleaseLane{key("a")});
    step_until(session, 60.0);
    EXPECT_NEAR(across(session, "a"), right_lane_m, 0.1F) << "returned to the right lane";
}

TEST(Commands, WithoutFreedomNoVehicleOvertakes) {
    for (const auto freedom : {traffic::LaneChangeFreedom::normal, traffic::LaneChangeFreedom::none}) {
        const Scene scene;
        Session session(scene.config(
            scene.straight_road(),
            vehicle("slow", "hv", 0, "in out", R"(departPos="60" departSpeed="3" departLane="0")") +
                one_vehicle()));
        session.step();
        apply(session, traffic::SetSpeed{key("slow"), core::MetresPerSecond(3.0)});
        apply(session, traffic::SetLaneChangeFreedom{key("slow"), traffic::LaneChangeFreedom::none});
        apply(session, traffic::SetLaneChangeFreedom{key("a"), freedom});
        step_until(session, 30.0);
        const bool overtook = place(session, "a") > place(session, "slow");
        EXPECT_EQ(overtook, freedom == traffic::LaneChangeFreedom::normal);
    }
}

TEST(Commands, AWayIsTakenAndKnownInTheNextStep) {
    const Scene scene;
    const sumo::SessionConfig config =
        scene.config(scene.crossing(), vehicle("a", "ev", 0, "west_in east_out", R"(departSpeed="10")"));
    Session session(config);
    session.step();
    const auto edge = [&](const char* id) {
        const std::vector<std::string>& edges = config.names.edges;
        return core::EdgeIndex{static_cast<std::uint32_t>(std::ranges::find(edges, id) - edges.begin())};
    };
    const auto route = [&] { return session.roster().route(session.roster().find(key("a"))->route); };
    apply(session, traffic::SetRoute{key("a"), {edge("west_in"), edge("north_out")}});
    session.step();
    EXPECT_EQ(route(), (std::vector{edge("west_in"), edge("north_out")}));
    EXPECT_EQ(session.refused_commands(), 0U);
    apply(session, traffic::SetRoute{key("a"), {edge("south_in"), edge("north_out")}});
    EXPECT_EQ(session.refused_commands(), 1U) << "it is elsewhere";
    apply(session, traffic::SetRoute{key("a"), {edge("west_in"), edge("south_in")}});
    EXPECT_EQ(session.refused_commands(), 2U) << "no way for SUMO";
    session.step();
    EXPECT_EQ(route(), (std::vector{edge("west_in"), edge("north_out")}));
    EXPECT_THROW(apply(session, traffic::SetRoute{key("a"), {}}), std::invalid_argument);
    EXPECT_THROW(apply(session, traffic::SetRoute{key("a"), {core::EdgeIndex{9999}}}), std::invalid_argument);
}

TEST(Commands, StopsAtThePositionAndResumes) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), one_vehicle()));
    session.step();
    apply(session, traffic::StopOnLane{key("a"), core::Metres(200.0), core::Seconds(500.0)});
    step_until(session, 60.0);
    EXPECT_NEAR(place(session, "a"), 200.0F, 1.0F);
    EXPECT_EQ(speed(session, "a"), 0.0F);
    EXPECT_EQ(session.snapshot().commanded_stops, std::vector{key("a")});
    apply(session, traffic::ResumeFromStop{key("a")});
    step_until(session, 75.0);
    EXPECT_GT(place(session, "a"), 250.0F);
    EXPECT_TRUE(session.snapshot().commanded_stops.empty());
}

TEST(Commands, StopThatIsResumedBeforeItIsReachedNeverHappens) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), one_vehicle()));
    session.step();
    apply(session, traffic::StopOnLane{key("a"), core::Metres(200.0), core::Seconds(500.0)});
    step_until(session, 5.0);
    EXPECT_TRUE(session.snapshot().commanded_stops.empty()) << "on its way there";
    apply(session, traffic::ResumeFromStop{key("a")});
    apply(session, traffic::ResumeFromStop{key("a")});
    step_until(session, 60.0);
    EXPECT_GT(session.snapshot().x_m[0], 600.0F) << "on the next edge";
}

/// A vehicle that stops by itself at 100 m for 20 s.
std::string vehicle_with_a_stop() {
    return R"(<vehicle id="a" type="hv" depart="0" departSpeed="10" departLane="0"><route edges="in out"/>)"
           R"(<stop lane="in_0" endPos="100" duration="20"/></vehicle>)";
}

TEST(Commands, AStopOfItsOwnIsKeptAndOursIsCancelled) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), vehicle_with_a_stop()));
    session.step();
    apply(session, traffic::StopOnLane{key("a"), core::Metres(300.0), core::Seconds(500.0)});
    step_until(session, 20.0);
    EXPECT_NEAR(place(session, "a"), 100.0F, 1.0F) << "at its own";
    EXPECT_TRUE(session.snapshot().commanded_stops.empty()) << "nobody commanded that";
    apply(session, traffic::ResumeFromStop{key("a")});
    step_until(session, 22.0);
    EXPECT_EQ(speed(session, "a"), 0.0F);
    step_until(session, 70.0);
    EXPECT_GT(session.snapshot().x_m[0], 350.0F) << "it drove on past ours";
}

TEST(Commands, OurStopAfterAStopOfItsOwnIsMadeAndEnds) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), vehicle_with_a_stop()));
    session.step();
    apply(session, traffic::StopOnLane{key("a"), core::Metres(300.0), core::Seconds(500.0)});
    step_until(session, 70.0);
    EXPECT_NEAR(place(session, "a"), 300.0F, 1.0F);
    EXPECT_EQ(session.snapshot().commanded_stops, std::vector{key("a")});
    apply(session, traffic::ResumeFromStop{key("a")});
    step_until(session, 80.0);
    EXPECT_GT(place(session, "a"), 320.0F);
}

TEST(Commands, StopTooNearIsMadeAsSoonAsBrakingAllows) {
    for (const double step_s : {0.1, 0.25, 1.0}) {
        const Scene scene;
        auto config = scene.config(scene.straight_road(), one_vehicle());
        config.step_length = core::Seconds(step_s);
        Session session(config);
        step_until(session, 10.0);
        const float start_m = place(session, "a");
        const float speed_mps = speed(session, "a");
        apply(session, traffic::StopOnLane{key("a"), core::Metres(start_m), core::Seconds(500.0)});
        double hardest_mps2 = 0.0;
        for (int i = 0; i < 40.0 / step_s; ++i) {
            session.step();
            hardest_mps2 = std::min<double>(hardest_mps2, session.snapshot().acceleration_mps2[0]);
        }
        EXPECT_EQ(speed(session, "a"), 0.0F) << step_s;
        EXPECT_LT(place(session, "a"), start_m + speed_mps * speed_mps / 9.0F + speed_mps * step_s + 1.0F)
            << step_s;
        EXPECT_GE(hardest_mps2, -4.5 - 1e-3) << step_s;
    }
}

TEST(Commands, StopBeyondTheEndOfTheLaneIsRefusedAndCounted) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), one_vehicle()));
    while (session.snapshot().size() == 0 || place(session, "a") < 490.0F)
        session.step();
    ASSERT_LT(place(session, "a"), 500.0F);
    apply(session, traffic::StopOnLane{key("a"), core::Metres(495.0), core::Seconds(5.0)});
    EXPECT_EQ(session.refused_commands(), 1U);
    step_until(session, session.time().value + 10.0);
    EXPECT_GT(speed(session, "a"), 13.0F);
}

TEST(Commands, AlignmentMovesAVehicleWithinItsLaneAndBack) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), one_vehicle());
    config.extra_arguments = {"--lateral-resolution", "0.5"};
    Session session(config);
    step_until(session, 2.0);
    const float usual_m = across(session, "a");
    apply(session, traffic::SetLaneChangeFreedom{key("a"), traffic::LaneChangeFreedom::none});
    apply(session, traffic::SetLateralAlignment{key("a"), traffic::LateralAlignment::right});
    step_until(session, 10.0);
    EXPECT_LT(across(session, "a"), usual_m - 0.4F);
    apply(session, traffic::SetLateralAlignment{key("a"), traffic::LateralAlignment::usual});
    step_until(session, 18.0);
    EXPECT_NEAR(across(session, "a"), usual_m, 0.1F);
}

TEST(Commands, AVehicleBesideTheRoadIsInNobodysWayAndReturnsWhenItResumes) {
    const Scene scene;
    Session session(
        scene.config(scene.straight_road(),
                     one_vehicle() + vehicle("b", "hv", 30, "in out", R"(departSpeed="10" departLane="0")")));
    session.step();
    apply(session, traffic::StopOnLane{key("a"), core::Metres(100.0), core::Seconds(500.0),
                                       traffic::StopPlace::beside_road});
    step_until(session, 25.0);
    EXPECT_FALSE(session.snapshot().row_of(key("a"))) << "beside the road";
    ASSERT_EQ(session.snapshot().beside_road.size(), 1U);
    EXPECT_EQ(session.snapshot().commanded_stops, std::vector{key("a")});
    EXPECT_EQ(session.snapshot().beside_road[0].key, key("a"));
    EXPECT_EQ(session.snapshot().beside_road[0].vehicle_class, traffic::VehicleClass::human);
    EXPECT_NEAR(session.snapshot().beside_road[0].state.x_m, 100.0F, 1.0F);
    EXPECT_NEAR(session.snapshot().beside_road[0].state.lane_position_m, 100.0F, 1.0F);
    step_until(session, 31.0);
    apply(session, traffic::SetLaneChangeFreedom{key("b"), traffic::LaneChangeFreedom::none});
    step_until(session, 60.0);
    EXPECT_GT(place(session, "b"), 150.0F) << "passed on the same lane";
    apply(session, traffic::ResumeFromStop{key("a")});
    step_until(session, 70.0);
    ASSERT_TRUE(session.snapshot().row_of(key("a")));
    EXPECT_TRUE(session.snapshot().beside_road.empty());
    EXPECT_GT(speed(session, "a"), 5.0F);
    step_until(session, 200.0);
    EXPECT_FALSE(session.snapshot().row_of(key("a"))) << "arrived";
    EXPECT_EQ(session.skipped_commands(), 0U);
}

TEST(Commands, AVehicleSteersAcrossTheLineBetweenTwoLanesAndBack) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), one_vehicle());
    config.extra_arguments = {"--lateral-resolution", "0.5"};
    Session session(config);
    step_until(session, 2.0);
    const float usual_m = across(session, "a");
    apply(session, traffic::SetLaneChangeFreedom{key("a"), traffic::LaneChangeFreedom::none});
    apply(session, traffic::SetLateralAlignment{key("a"), traffic::LateralAlignment::free});
    const auto steer_to = [&](float target_m, double until_s) {
        while (session.time().value < until_s) {
            apply(session, traffic::SteerSideways{key("a"), core::Metres(target_m - across(session, "a"))});
            session.step();
        }
    };
    steer_to(usual_m + 1.6F, 12.0);
    EXPECT_NEAR(across(session, "a"), usual_m + 1.6F, 0.2F) << "on the line";
    steer_to(usual_m, 22.0);
    EXPECT_NEAR(across(session, "a"), usual_m, 0.2F);
}

TEST(Commands, PrivilegedVehiclePassesRedSlowlyAndTheOthersDoNot) {
    const Scene scene;
    const auto config =
        scene.config(scene.crossing(), vehicle("free", "ev", 0, "west_in east_out", R"(departLane="1")") +
                                           vehicle("bound", "hv", 0, "south_in north_out") +
                                           vehicle("once", "ev", 0, "east_in west_out", R"(departLane="1")"));
    Session session(config);
    session.step();
    const std::size_t links = session.snapshot().signals.state.at(0).size();
    apply(session, traffic::SetSignalState{core::SignalIndex{0}, std::string(links, 'r')});
    apply(session, traffic::SetJunctionPrivilege{key("free"), traffic::JunctionPrivilege::pass_red});
    apply(session, traffic::SetJunctionPrivilege{key("once"), traffic::JunctionPrivilege::pass_red});
    apply(session, traffic::SetJunctionPrivilege{key("once"), traffic::JunctionPrivilege::none});
    float approach_mps = 0.0F;
    float at_line_mps = -1.0F;
    while (session.time().value < 60.0) {
        session.step();
        const auto row = session.snapshot().row_of(key("free"));
        if (!row || at_line_mps >= 0.0F) continue;
        const bool in_junction = config.names.lanes.at(session.snapshot().lane[*row].value).starts_with(':');
        approach_mps = std::max(approach_mps, speed(session, "free"));
        if (in_junction) at_line_mps = speed(session, "free");
    }
    EXPECT_FALSE(session.snapshot().row_of(key("free"))) << "should have passed and arrived";
    EXPECT_GT(approach_mps, 12.0F);
    EXPECT_GT(at_line_mps, 0.0F);
    EXPECT_LT(at_line_mps, 7.0F) << "its type says 5 m/s at red";
    EXPECT_EQ(speed(session, "bound"), 0.0F);
    EXPECT_EQ(speed(session, "once"), 0.0F);
}

TEST(Commands, PrivilegedVehicleYieldsToThoseWithGreen) {
    const Scene scene;
    std::string crossing_traffic;
    for (int i = 0; i < 40; ++i) {
        crossing_traffic += vehicle("cross" + std::to_string(i), "hv", 1.5 * i, "south_in north_out",
                                    R"(departLane="random" departSpeed="max")");
    }
    Session session(
        scene.config(scene.crossing(),
                     vehicle("free", "ev", 0, "west_in east_out", R"(departLane="1")") + crossing_traffic));
    session.step();
    std::string state;
    for (const char letter : session.snapshot().signals.state.at(0)) {
        state += letter == 'r' ? 'r' : 'G';
    }
    const bool west_is_red = state[0] == 'G';  // links are numbered from the north, clockwise
    ASSERT_TRUE(west_is_red) << state;
    apply(session, traffic::SetSignalState{core::SignalIndex{0}, state});
    apply(session, traffic::SetJunctionPrivilege{key("free"), traffic::JunctionPrivilege::pass_red});
    while (session.expected_vehicles() > 0 && session.time().value < 150.0) {
        session.step();
        EXPECT_TRUE(session.events().collisions.empty()) << session.time().value;
    }
    EXPECT_FALSE(session.snapshot().row_of(key("free")));
}

TEST(Commands, SignalShowsTheStateAndReturnsToItsProgram) {
    const Scene scene;
    const auto config = scene.config(scene.crossing(), "");
    std::vector<std::string> untouched;
    {
        Session session(config);
        for (int i = 0; i < 800; ++i) {
            session.step();
            untouched.push_back(session.snapshot().signals.state.at(0));
        }
    }
    Session session(config);
    const std::string green(untouched.front().size(), 'G');
    bool held_back = false;
    for (int i = 0; i < 800; ++i) {
        if (i == 101) apply(session, traffic::SetSignalState{core::SignalIndex{0}, green});
        if (i == 300) apply(session, traffic::SetSignalState{core::SignalIndex{0}, green});
        if (i == 471) apply(session, traffic::RestoreProgram{core::SignalIndex{0}});
        session.step();
        const std::string& shown = session.snapshot().signals.state.at(0);
        if (i >= 101 && i < 471) {
            EXPECT_EQ(shown, green) << i;
            held_back |= untouched[i] != green;
        } else {
            EXPECT_EQ(shown, untouched[i]) << i;
        }
    }
    EXPECT_TRUE(held_back);
}

TEST(Commands, SignalRestartsAtAPhaseWhenAsked) {
    const Scene scene;
    Session session(scene.config(scene.crossing(), ""));
    session.step();
    const std::string first = session.snapshot().signals.state.at(0);
    const std::string red(first.size(), 'r');
    apply(session, traffic::SetSignalState{core::SignalIndex{0}, red});
    step_until(session, 100.0);
    apply(session, traffic::RestoreProgram{core::SignalIndex{0}, 0});
    double green_s = 0.0;
    do {
        session.step();
        green_s += 0.25;
    } while (session.snapshot().signals.state.at(0) == first && green_s < 200.0);
    EXPECT_GT(green_s, 20.0) << "the phase starts at its beginning";
    EXPECT_LT(green_s, 60.0) << "and ends by itself";

    step_until(session, 300.0);
    apply(session, traffic::RestoreProgram{core::SignalIndex{0}, 0, core::Seconds(7.0)});
    for (green_s = 0.0; green_s < 200.0; green_s += 0.25) {
        session.step();
        if (session.snapshot().signals.state.at(0) != first) break;
    }
    EXPECT_NEAR(green_s, 7.0, 0.3) << "or as long as it is told";
}

}  // namespace
}  // namespace clearway
