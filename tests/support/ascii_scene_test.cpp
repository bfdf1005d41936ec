#include "support/ascii_scene.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

#include "roads/route.hpp"

namespace clearway::support {
namespace {

using ::testing::ElementsAre;

constexpr const char* two_lanes = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    ..h..a...|G....h
    ..e......|r.....
)";

TEST(AsciiScene, PutsVehiclesOnTheirLanes) {
    const Scene scene(two_lanes);
    ASSERT_EQ(scene.snapshot().size(), 4u);
    const auto first = scene.snapshot().motion(scene.row("h1"));
    EXPECT_EQ(scene.network().lane(first.lane).id, "road_0_1");
    EXPECT_FLOAT_EQ(first.lane_position_m, 25.0F);
    EXPECT_FLOAT_EQ(first.x_m, 25.0F);
    EXPECT_FLOAT_EQ(first.y_m, 3.2F);
    EXPECT_FLOAT_EQ(first.speed_mps, 15.0F);
    const auto beyond = scene.snapshot().motion(scene.row("h2"));
    EXPECT_EQ(scene.network().lane(beyond.lane).id, "road_1_1");
    EXPECT_FLOAT_EQ(beyond.x_m, 135.0F);
    EXPECT_EQ(beyond.route_edge, 1u);
    EXPECT_EQ(scene.snapshot().vehicle_class[scene.row("e1")], traffic::VehicleClass::emergency);
    EXPECT_EQ(scene.roster().find(scene.key("e1"))->kind, traffic::VehicleKind::ambulance);
    EXPECT_EQ(scene.id(scene.key("a1")), "a1");
    EXPECT_TRUE(std::ranges::is_sorted(scene.snapshot().key));
    EXPECT_FLOAT_EQ(scene.network().lanes()[0].speed_limit_mps, 20.0F);
    EXPECT_THROW(scene.key("h3"), std::out_of_range);
}

TEST(AsciiScene, SignalsControlLanesAndACrossingStreet) {
    const Scene scene(two_lanes);
    ASSERT_EQ(scene.network().signals().size(), 1u);
    const roads::Signal& signal = scene.network().signals()[0];
    EXPECT_EQ(signal.id, "signal_0");
    EXPECT_EQ(scene.network().lane(signal.links[1][0].from).id, "road_0_1");
    EXPECT_EQ(scene.network().lane(signal.links[2][0].from).id, "cross_0_in_0");
    EXPECT_TRUE(signal.foes[0][2] && signal.foes[1][2] && signal.foes[2][0]);
    EXPECT_FALSE(signal.foes[0][1]);
    EXPECT_EQ(signal.program[0].state, "GGr");
    // Lane 0 is the lower line, so its letter comes first.
    EXPECT_THAT(scene.snapshot().signals.state, ElementsAre("rGr"));
    const Scene all_red("10 m per cell\n...|r...");
    EXPECT_THAT(all_red.snapshot().signals.state, ElementsAre("rG"));
}

TEST(AsciiScene, LanesMayBeginAndEndBetweenEdges) {
    const Scene scene(R"(
        5 m per cell
        ####+h...+####
        ....+....+....
        e...+....+####
    )");
    const roads::Network& network = scene.network();
    EXPECT_EQ(network.edge(*network.find_edge("road_0")).lane_count, 2u);
    EXPECT_EQ(network.edge(*network.find_edge("road_1")).lane_count, 3u);
    EXPECT_EQ(network.edge(*network.find_edge("road_2")).lane_count, 1u);
    EXPECT_TRUE(network.signals().empty());
    const auto& route = scene.roster().route(core::RouteIndex{0});
    // The middle line is lane 1, then lane 0; the lower one ends with road_1.
    const auto drivable = [&](const char* lane) {
        return roads::drivable(network, route, 0, *network.find_lane(lane), core::Metres(0.0),
                               core::Metres(1000.0))
            .value;
    };
    EXPECT_NEAR(drivable("road_0_1"), 60.0, 1e-4);
    EXPECT_NEAR(drivable("road_0_0"), 40.0, 1e-4);
    EXPECT_EQ(network.lane(scene.snapshot().lane[scene.row("h1")]).id, "road_1_2");
}

TEST(AsciiScene, TimePasses) {
    Scene scene(two_lanes);
    scene.set_speed("e1", core::MetresPerSecond(10.0));
    for (const double step_s : {0.1, 0.25, 1.0}) {
        const float before_m = scene.snapshot().x_m[scene.row("e1")];
        scene.pass(core::Seconds(step_s));
        EXPECT_NEAR(scene.snapshot().x_m[scene.row("e1")] - before_m, 10.0 * step_s, 1e-4);
    }
    EXPECT_NEAR(scene.snapshot().time.value, 101.35, 1e-9);
}

TEST(AsciiScene, PerfectBeliefHoldsTrueStatesAndAllowedLinks) {
    const Scene scene(R"(
        10 m per cell
        h....a....a
        .....e.....
    )");
    const traffic::BelievedGraph belief = perfect_belief(scene);
    ASSERT_EQ(belief.vehicles.size(), 4u);
    ASSERT_EQ(belief.own_states.size(), 1u);
    EXPECT_EQ(belief.own_states[0].key, scene.key("e1"));
    // e1 - a1 (3.2 m), but not a1 - a2 (two automated), nor h1 and a2 with anyone: 50 m is not below 50 m.
    EXPECT_EQ(belief.link_count(), 1u);
    ASSERT_EQ(belief.links_of(scene.row("a1")).size(), 1u);
    EXPECT_EQ(belief.links_of(scene.row("a1"))[0].neighbour, scene.row("e1"));
    EXPECT_NEAR(belief.links_of(scene.row("a1"))[0].distance_m, 3.2, 1e-5);
    const traffic::Observation observation = perfect_observation(scene);
    EXPECT_EQ(observation.vehicles.size(), 4u);
    EXPECT_EQ(observation.own_states.size(), 1u);
    EXPECT_EQ(observation.roster, &scene.roster());
}

TEST(AsciiScene, RefusesDrawingsThatBreakTheRules) {
    for (const char* drawing :
         {"", "10 m per cell", "....\n....", "0 m per cell\n...", "10 m per cell, fast\n...",
          "10 m per cell\n...\n..", "10 m per cell\n.x.", "10 m per cell\n.|.", "10 m per cell\n..|G.\n.|G..",
          "10 m per cell\n.#..", "10 m per cell\n###", "10 m per cell\n|G..", "10 m per cell\n..+|G.."}) {
        EXPECT_THROW(Scene{drawing}, std::invalid_argument) << drawing;
    }
}

}  // namespace
}  // namespace clearway::support
