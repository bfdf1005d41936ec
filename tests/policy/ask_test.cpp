// Whom a policy asks: everyone, or those that the believed graph links with the emergency vehicle.
#include "policy/ask.hpp"

#include <gtest/gtest.h>

#include "policy/clear_lane.hpp"
#include "policy/straight_road.hpp"

namespace clearway::testing {
namespace {

using policy::Ask;
using policy::Audience;

constexpr const char* chain = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    e...a...a...h...a.............a
)";
constexpr graph::LinkRules with_relays = {.radius_m = 50.0,
                                          .automated_automated = graph::LinkRules::Pairs::included};

TEST(Audience, OfEveryoneHasThoseWithoutALink) {
    const support::Scene scene(chain);
    const Audience all(support::perfect_belief(scene), scene.key("e1"), {});
    EXPECT_TRUE(all.has(scene.key("a1")));
    EXPECT_TRUE(all.has(scene.key("a4")));
}

TEST(Audience, OfTheLinkedHasTheEndsOfItsLinksAlone) {
    const support::Scene scene(chain);
    const Audience linked(support::perfect_belief(scene), scene.key("e1"), {.ask = Ask::linked});
    EXPECT_TRUE(linked.has(scene.key("a1"))) << "40 m";
    EXPECT_FALSE(linked.has(scene.key("a2"))) << "80 m";
    EXPECT_FALSE(linked.has(scene.key("e1")));
}

TEST(Audience, GrowsByRelaysOfAutomatedVehicles) {
    const support::Scene scene(chain);
    const traffic::BelievedGraph belief = support::perfect_belief(scene, with_relays);
    const Audience two(belief, scene.key("e1"), {.ask = Ask::linked, .ask_hops = 2});
    EXPECT_TRUE(two.has(scene.key("a2")));
    EXPECT_FALSE(two.has(scene.key("h1"))) << "three links away";
    const Audience five(belief, scene.key("e1"), {.ask = Ask::linked, .ask_hops = 5});
    EXPECT_TRUE(five.has(scene.key("h1")));
    EXPECT_FALSE(five.has(scene.key("a3"))) << "a human driver sends nothing on, and a2 is 80 m behind";
}

TEST(Audience, CountsLinksFromItsThresholdUp) {
    const support::Scene scene(chain);
    traffic::BelievedGraph belief = support::perfect_belief(scene);
    for (traffic::BelievedLink& link : belief.links)
        link.probability = 0.6F;
    EXPECT_TRUE(Audience(belief, scene.key("e1"), {Ask::linked, 0.6}).has(scene.key("a1")));
    EXPECT_FALSE(Audience(belief, scene.key("e1"), {Ask::linked, 0.61}).has(scene.key("a1")));
}

TEST(Audience, OfAnEmergencyVehicleThatNobodyHasHeardIsEmpty) {
    const support::Scene scene(chain);
    traffic::BelievedGraph nothing;
    nothing.first_link = {0};
    EXPECT_FALSE(Audience(nothing, scene.key("e1"), {.ask = Ask::linked}).has(scene.key("a1")));
}

constexpr const char* queue = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    ..e..a........a.............a......
    ..........a........................
)";

TEST(ClearLane, that_asks_the_linked_leaves_the_others_alone) {
    StraightRoad road(queue);
    policy::ClearLaneConfig config;
    config.ask = Ask::linked;
    policy::ClearLane policy({road.scene.network()}, config);
    road.act(policy);
    EXPECT_EQ(road.asked_lane("a1"), 0U) << "30 m ahead";
    EXPECT_FALSE(road.asked_lane("a2")) << "120 m ahead: no link";
    EXPECT_FALSE(road.asked<traffic::HoldLane>("a4")) << "80 m ahead: no link";
}

TEST(ClearLane, that_asks_the_linked_still_takes_the_emergency_vehicle_to_the_better_lane) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ..e.......h........
        ...................
    )");
    road.scene.set_speed("h1", core::MetresPerSecond(8.0));
    policy::ClearLaneConfig config;
    config.ask = Ask::linked;
    policy::ClearLane policy({road.scene.network()}, config);
    road.act(policy);
    EXPECT_EQ(road.asked_lane("e1"), 0U);
}

}  // namespace
}  // namespace clearway::testing
