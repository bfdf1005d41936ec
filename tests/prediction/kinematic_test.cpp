#include "prediction/kinematic.hpp"

#include <gmock/gmock.h>

#include "prediction/darkness.hpp"

namespace clearway::prediction {
namespace {

using testing::after_outage;
using testing::link;
using testing::side_by_side;

traffic::BelievedGraph belief_of(const char* name, const support::Scene& scene,
                                 const traffic::Observation& observation) {
    const auto predictor = make_predictor(name, {scene.network(), {}, "", {}});
    traffic::BelievedGraph belief;
    predictor->predict(observation, belief);
    return belief;
}

TEST(DeadReckoning, RestoresTheLinkOfAVehicleThatKeptItsSpeed) {
    support::Scene scene(side_by_side);
    const auto belief = belief_of("dead_reckoning", scene, after_outage(scene, 5.0, {"a1"}));
    EXPECT_GT(link(scene, belief, "e1", "a1").value_or(0.0F), 0.5F);
    const traffic::BelievedVehicle& believed = *belief.find(scene.key("a1"));
    EXPECT_NEAR(believed.state.x_m, 135.0F, 1e-3F);
    EXPECT_EQ(believed.age_s, 5.0F);
    EXPECT_FLOAT_EQ(believed.sigma_m, 12.5F);
}

TEST(LastSeen, LosesTheLinkOfAVehicleThatKeptItsSpeed) {
    support::Scene scene(side_by_side);
    const auto belief = belief_of("last_seen", scene, after_outage(scene, 5.0, {"a1"}));
    EXPECT_FALSE(link(scene, belief, "e1", "a1").has_value());
    EXPECT_NEAR(belief.find(scene.key("a1"))->state.x_m, 35.0F, 1e-3F);
}

TEST(LastSeen, KeepsTheLinkOfAVehicleThatStands) {
    support::Scene scene(side_by_side);
    scene.set_speed("a1", core::MetresPerSecond(0.0));
    scene.set_speed("e1", core::MetresPerSecond(0.0));
    const auto belief = belief_of("last_seen", scene, after_outage(scene, 5.0, {"a1"}));
    EXPECT_GT(link(scene, belief, "e1", "a1").value_or(0.0F), 0.5F);
}

TEST(NoRepair, KnowsNoDarkVehicle) {
    support::Scene scene(side_by_side);
    const auto belief = belief_of("none", scene, after_outage(scene, 1.0, {"a1"}));
    EXPECT_EQ(belief.find(scene.key("a1")), nullptr);
    EXPECT_EQ(belief.vehicles.size(), 1u);
    EXPECT_EQ(belief.link_count(), 0u);
}

TEST(NoRepair, LinksNoisyReportsByTheirMeasuredDistance) {
    support::Scene scene(side_by_side);
    traffic::Observation observation = support::perfect_observation(scene);
    for (traffic::ObservedVehicle& vehicle : observation.vehicles) {
        vehicle.position_sigma_m = 3.0F;
    }
    EXPECT_EQ(link(scene, belief_of("none", scene, observation), "e1", "a1"), 1.0F);
}

TEST(DeadReckoning, LetsVehiclesLeaveAtTheEndOfTheirRoute) {
    support::Scene scene(side_by_side);
    // a1 is 255 m before the end: it left after 12.75 s. The drawing stops e1 there.
    const auto before = belief_of("dead_reckoning", scene, after_outage(scene, 12.0, {"a1"}));
    EXPECT_NE(before.find(scene.key("a1")), nullptr);
    support::Scene later(side_by_side);
    traffic::Observation unknown = after_outage(later, 14.0, {"a1"});
    unknown.exits_known = false;
    const auto after = belief_of("dead_reckoning", later, unknown);
    EXPECT_EQ(after.find(later.key("a1")), nullptr);
    EXPECT_EQ(after.link_count(), 0u);
    unknown.exits_known = true;
    EXPECT_NE(belief_of("dead_reckoning", later, unknown).find(later.key("a1")), nullptr)
        << "no detector saw it leave";
    support::Scene held(side_by_side);
    EXPECT_NE(belief_of("last_seen", held, after_outage(held, 14.0, {"a1"})).find(held.key("a1")), nullptr);
}

TEST(DeadReckoning, GoesStraightOnWhereNoRouteIsKnown) {
    support::Scene scene(side_by_side);
    traffic::Observation observation = after_outage(scene, 5.0, {"a1"});
    const traffic::Roster nobody;
    observation.roster = &nobody;
    const auto belief = belief_of("dead_reckoning", scene, observation);
    EXPECT_NEAR(belief.find(scene.key("a1"))->state.x_m, 135.0F, 1e-3F);
    EXPECT_FALSE(belief.find(scene.key("a1"))->state.lane.exists());
}

TEST(DeadReckoning, MovesFreshVehiclesBetweenReports) {
    support::Scene scene(side_by_side);
    traffic::Observation observation = support::perfect_observation(scene);
    for (traffic::ObservedVehicle& vehicle : observation.vehicles) {
        vehicle.age_s = 0.5F;
    }
    observation.vehicles[scene.row("e1")].state.speed_mps = 0.0F;
    const auto belief = belief_of("dead_reckoning", scene, observation);
    EXPECT_NEAR(belief.find(scene.key("a1"))->state.x_m, 45.0F, 1e-3F);
    EXPECT_NEAR(belief.find(scene.key("e1"))->state.x_m, 25.0F, 1e-3F);
    EXPECT_EQ(link(scene, belief, "e1", "a1"), 1.0F);
    EXPECT_NEAR(belief.links[0].distance_m, std::hypot(20.0F, 3.2F), 1e-3F);
    EXPECT_NEAR(belief_of("last_seen", scene, observation).links[0].distance_m, std::hypot(10.0F, 3.2F),
                1e-3F);
}

TEST(DetectedLinks, AreListedWithTheirRangeWhereverTheVehicleIsBelieved) {
    support::Scene scene(side_by_side);
    traffic::Observation observation = after_outage(scene, 5.0, {"a1"});
    observation.detected_links = {{scene.key("e1"), scene.key("a1"), 12.0F, 1.0F}};
    const auto belief = belief_of("last_seen", scene, observation);
    EXPECT_EQ(link(scene, belief, "e1", "a1"), 1.0F);
    EXPECT_EQ(belief.links[0].distance_m, 12.0F);
    observation.detected_links[0].range_m = -1.0F;
    EXPECT_LT(belief_of("last_seen", scene, observation).links[0].distance_m, 50.0F)
        << "100 m by last seen, but detection tells that it is within the radius";
}

TEST(ProbabilityWithin, IsOneHalfAtTheRadiusAndFallsWithDistance) {
    EXPECT_FLOAT_EQ(probability_within(50.0F, 50.0F, 10.0F), 0.5F);
    EXPECT_NEAR(probability_within(50.0F, 40.0F, 10.0F), 0.8413447F, 1e-6F);
    EXPECT_NEAR(probability_within(50.0F, 60.0F, 10.0F), 0.1586553F, 1e-6F);
    EXPECT_EQ(probability_within(50.0F, 49.0F, 0.0F), 1.0F);
    EXPECT_EQ(probability_within(50.0F, 50.0F, 0.0F), 0.0F);
}

TEST(Sigmas, GrowWithAge) {
    EXPECT_FLOAT_EQ(held_sigma_m(3.0F, 0.0F, 2.0F), 5.0F);
    EXPECT_FLOAT_EQ(held_sigma_m(0.0F, 10.0F, 2.0F), 24.0F);
    EXPECT_FLOAT_EQ(dead_reckoned_sigma_m(0.0F, 4.0F), 10.0F);
    EXPECT_FLOAT_EQ(dead_reckoned_sigma_m(3.0F, 0.0F), 3.0F);
}

}  // namespace
}  // namespace clearway::prediction
