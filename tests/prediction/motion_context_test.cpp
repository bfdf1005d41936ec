#include "prediction/motion_context.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "prediction/darkness.hpp"

namespace clearway::prediction {
namespace {

/// What the builder says of `dark` after an outage that it saw begin.
class Outage {
  public:
    explicit Outage(const char* road)
        : scene_(road), scenes_(scene_.network(), {}), builder_(scene_.network(), {}) {}

    support::Scene& scene() { return scene_; }

    MotionContext after(double age_s, const char* dark, std::vector<traffic::DetectedLink> detected = {}) {
        see(support::perfect_observation(scene_));
        traffic::Observation now = testing::after_outage(scene_, age_s, {dark});
        now.detected_links = std::move(detected);
        see(now);
        EXPECT_EQ(ahead_.size(), 1u);
        return ahead_.at(0);
    }

  private:
    void see(const traffic::Observation& observation) {
        prediction::Scene scene;
        scenes_.build(observation, scene);
        builder_.build(observation, scene, ahead_);
    }

    support::Scene scene_;
    SceneBuilder scenes_;
    MotionContextBuilder builder_;
    std::vector<MotionContext> ahead_;
};

TEST(MotionContext, HoldsAVehicleAtARedLightAndNotAtAGreenOne) {
    // a1's front is 75 m before the line and would be 25 m behind it after 5 s.
    Outage red(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a.......|r..........
        e.......|r..........
    )");
    const MotionContext held = red.after(5.0, "a1");
    EXPECT_NEAR(held.line.distance_m, 75.0F, 0.01F);
    EXPECT_EQ(held.line.state, 'r');
    EXPECT_TRUE(held.held_by_signal);
    EXPECT_NEAR(held.travelled_m, 100.0F, 0.01F);
    EXPECT_NEAR(held.displacement_m, 75.0F, 0.01F);
    EXPECT_NEAR(held.place_at(held.displacement_m).x_m, 80.0F, 0.1F);
    Outage green(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a.......|G..........
        e.......|r..........
    )");
    const MotionContext free = green.after(5.0, "a1");
    EXPECT_FALSE(free.held_by_signal);
    EXPECT_NEAR(free.displacement_m, 100.0F, 0.01F);
    EXPECT_NEAR(free.place_at(free.displacement_m).x_m, 105.0F, 0.1F);
    EXPECT_FLOAT_EQ(free.direction_at(50.0F).x_m, 1.0F);
}

TEST(MotionContext, TellsSinceWhenASignalShowsItsLetter) {
    Outage outage(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a.......|r..........
    )");
    EXPECT_FLOAT_EQ(outage.after(5.0, "a1").line.state_age_s, 5.0F);
}

TEST(MotionContext, HoldsAVehicleBehindTheOneThatWasAheadOfIt) {
    Outage outage(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a...h...............
        ....e...............
    )");
    outage.scene().set_speed("h1", core::MetresPerSecond(2.0));
    // h1 stands 40 m ahead and comes 10 m further; its rear is 5 m behind its front, the gap 2.5 m.
    const MotionContext ahead = outage.after(5.0, "a1");
    ASSERT_TRUE(ahead.leader.exists);
    EXPECT_TRUE(ahead.leader.known);
    EXPECT_NEAR(ahead.leader.distance_m, 50.0F, 0.01F);
    EXPECT_TRUE(ahead.held_by_leader);
    EXPECT_NEAR(ahead.displacement_m, 42.5F, 0.01F);
    EXPECT_FALSE(ahead.follower.exists);
}

TEST(MotionContext, KnowsTheFollowerByWhatWasSeenBeforeTheOutage) {
    Outage outage(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        h..a................
    )");
    outage.scene().set_speed("a1", core::MetresPerSecond(0.0));
    outage.scene().set_speed("h1", core::MetresPerSecond(15.0));
    // h1 was 30 m behind and is now 45 m ahead of where a1 was seen: a1 must have gone on.
    const MotionContext ahead = outage.after(5.0, "a1");
    ASSERT_TRUE(ahead.follower.exists);
    EXPECT_NEAR(ahead.follower.distance_m, 45.0F, 0.01F);
    EXPECT_FALSE(ahead.leader.exists) << "who overtook by the map alone is no leader";
}

TEST(MotionContext, DrawsAVehicleToWhereItsDetectionIsPossible) {
    Outage outage(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a...................
        ..............e.....
    )");
    outage.scene().set_speed("a1", core::MetresPerSecond(0.0));
    outage.scene().set_speed("e1", core::MetresPerSecond(0.0));
    const core::VehicleKey e1 = outage.scene().key("e1");
    const core::VehicleKey a1 = outage.scene().key("a1");
    // 140 m apart: presence pulls it to within 50 m, as far as 20 s allow; a range of 10 m further.
    const MotionContext near = outage.after(20.0, "a1", {{e1, a1, -1.0F, 0.0F}});
    EXPECT_EQ(near.detections, 1u);
    EXPECT_GT(near.displacement_m, 70.0F);
    EXPECT_LT(near.displacement_m, 100.0F);
    Outage ranged(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a...................
        ..............e.....
    )");
    ranged.scene().set_speed("a1", core::MetresPerSecond(0.0));
    ranged.scene().set_speed("e1", core::MetresPerSecond(0.0));
    const MotionContext measured = ranged.after(20.0, "a1", {{e1, a1, 10.0F, 1.0F}});
    EXPECT_GT(measured.displacement_m, near.displacement_m + 10.0F);
}

TEST(MotionContext, ReachesNoFurtherThanTheEndOfTheRoute) {
    Outage outage(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a.........
    )");
    const MotionContext ahead = outage.after(30.0, "a1");
    EXPECT_NEAR(ahead.route_left_m, 95.0F, 0.01F);
    EXPECT_NEAR(ahead.reach_m, 95.0F, 0.01F);
    EXPECT_NEAR(ahead.displacement_m, 95.0F, 0.01F);
}

TEST(RouteRule, HoldsAtRedWhereDeadReckoningDrivesThrough) {
    const char* const road = R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a.......|r..........
        ......e.|r..........
    )";
    for (const char* const name : {"route_rule", "dead_reckoning"}) {
        support::Scene scene(road);
        scene.set_speed("e1", core::MetresPerSecond(0.0));
        const auto predictor = make_predictor(name, {scene.network(), {}, "", {}});
        traffic::BelievedGraph belief;
        predictor->predict(testing::after_outage(scene, 8.0, {"a1"}), belief);
        const bool linked = testing::link(scene, belief, "e1", "a1").has_value();
        EXPECT_EQ(linked, std::string_view(name) == "route_rule") << name;
    }
}

TEST(RouteRule, LetsVehiclesLeaveOnlyWhereExitsAreUnknown) {
    for (const bool exits_known : {true, false}) {
        support::Scene scene(R"(
            10 m per cell, limit 20 m/s, speed 20 m/s
            a.........
            e.........
        )");
        traffic::Observation observation = testing::after_outage(scene, 30.0, {"a1"});
        observation.exits_known = exits_known;
        const auto predictor = make_predictor("route_rule", {scene.network(), {}, "", {}});
        traffic::BelievedGraph belief;
        predictor->predict(observation, belief);
        EXPECT_EQ(belief.find(scene.key("a1")) != nullptr, exits_known);
    }
}

}  // namespace
}  // namespace clearway::prediction
