// Whom a policy asks: everyone, or those that the believed graph links with the emergency vehicle.
#include "policy/ask.hpp"

#include <string>

#include <gtest/gtest.h>

#include "policy/clear_lane.hpp"
#include "policy/straight_road.hpp"

namespace clearway::testing {
namespace {

using policy::Ask;
using policy::AskSettings;
using policy::Audience;

constexpr const char* chain = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    e...a...a...h...a.............a
)";
constexpr graph::LinkRules with_relays = {.radius_m = 50.0,
                                          .automated_automated = graph::LinkRules::Pairs::included};

class AudienceTest : public ::testing::Test {
  protected:
    /// Whether the emergency vehicle asks the named one.
    bool asks(const std::string& name, const AskSettings& settings) const {
        return Audience(belief_, scene_.key("e1"), settings).has(*belief_.find(scene_.key(name)));
    }

    support::Scene scene_{chain};
    traffic::BelievedGraph belief_ = support::perfect_belief(scene_, with_relays);
};

TEST_F(AudienceTest, of_everyone_has_automated_vehicles_without_a_link) {
    EXPECT_TRUE(asks("a1", {}));
    EXPECT_TRUE(asks("a4", {}));
    EXPECT_FALSE(asks("h1", {}));
    EXPECT_FALSE(asks("e1", {}));
}

TEST_F(AudienceTest, has_human_drivers_where_they_are_asked) {
    EXPECT_TRUE(asks("h1", {.ask_humans = 1}));
    EXPECT_FALSE(asks("e1", {.ask_humans = 1}));
}

TEST_F(AudienceTest, of_the_linked_has_the_ends_of_its_links_alone) {
    EXPECT_TRUE(asks("a1", {.ask = Ask::linked})) << "40 m";
    EXPECT_FALSE(asks("a2", {.ask = Ask::linked})) << "80 m";
    EXPECT_FALSE(asks("e1", {.ask = Ask::linked}));
}

TEST_F(AudienceTest, grows_by_relays_of_automated_vehicles) {
    EXPECT_TRUE(asks("a2", {.ask = Ask::linked, .ask_hops = 2}));
    EXPECT_FALSE(asks("h1", {.ask = Ask::linked, .ask_hops = 2, .ask_humans = 1})) << "three links away";
    EXPECT_TRUE(asks("h1", {.ask = Ask::linked, .ask_hops = 5, .ask_humans = 1}));
    EXPECT_FALSE(asks("a3", {.ask = Ask::linked, .ask_hops = 5}))
        << "a human driver sends nothing on, and a2 is 80 m behind";
}

TEST_F(AudienceTest, counts_links_from_its_threshold_up) {
    for (traffic::BelievedLink& link : belief_.links)
        link.probability = 0.6F;
    EXPECT_TRUE(asks("a1", {Ask::linked, 0.6}));
    EXPECT_FALSE(asks("a1", {Ask::linked, 0.61}));
}

TEST_F(AudienceTest, of_an_emergency_vehicle_that_nobody_has_heard_is_empty) {
    traffic::BelievedGraph nothing;
    nothing.first_link = {0};
    EXPECT_FALSE(
        Audience(nothing, scene_.key("e1"), {.ask = Ask::linked}).has(*belief_.find(scene_.key("a1"))));
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
