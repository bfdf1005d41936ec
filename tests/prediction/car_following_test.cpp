#include "prediction/car_following.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "prediction/darkness.hpp"
#include "prediction/twin_traffic.hpp"

namespace clearway::prediction {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A scene whose vehicles all report at first; afterwards one of them is dark.
class Outage {
  public:
    explicit Outage(const std::string& drawing, const core::Settings& settings = {},
                    const char* predictor = "car_following")
        : scene_(drawing), predictor_(make_predictor(predictor, {scene_.network(), {}, "", {}}, settings)) {
        see();
    }

    support::Scene& scene() { return scene_; }
    float x_m(const char* id) const { return scene_.snapshot().x_m[scene_.row(id)]; }
    void show(char letter) { scene_.snapshot().signals.state[0].assign(4, letter); }
    void know_exits(bool known) { exits_known_ = known; }

    /// Everybody reports.
    const traffic::BelievedGraph& see() {
        last_ = support::perfect_observation(scene_);
        return ask(last_);
    }
    /// `id` says nothing for `seconds`, the others report every `interval_s`.
    const traffic::BelievedGraph& pass(double seconds, const char* id, double interval_s = 1.0) {
        for (double passed_s = 0.0; passed_s < seconds - 1e-9; passed_s += interval_s) {
            scene_.pass(core::Seconds(interval_s));
            traffic::Observation now = support::perfect_observation(scene_);
            now.exits_known = exits_known_;
            traffic::ObservedVehicle& vehicle = now.vehicles[scene_.row(id)];
            vehicle = last_.vehicles[scene_.row(id)];
            vehicle.freshness = traffic::Freshness::stale;
            vehicle.age_s = static_cast<float>((now.time - last_.time).value);
            ask(now);
        }
        return belief_;
    }
    const traffic::BelievedGraph& ask(const traffic::Observation& observation) {
        predictor_->predict(observation, belief_);
        return belief_;
    }
    traffic::MotionState believed(const char* id) const { return belief_.find(scene_.key(id))->state; }
    bool is_believed(const char* id) const { return belief_.find(scene_.key(id)) != nullptr; }

  private:
    support::Scene scene_;
    std::unique_ptr<Predictor> predictor_;
    traffic::Observation last_;
    traffic::BelievedGraph belief_;
    bool exits_known_ = true;
};

constexpr const char* in_line = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    a....h...............................
    ..e..................................
)";
constexpr const char* at_the_line = R"(
    10 m per cell, limit 20 m/s, speed 0 m/s
    .......a|r..............................
    ........|r...........e..................
)";

/// `h1` brakes by 3 m/s a second and stands after 5 s.
void brake(Outage& outage) {
    for (double speed_mps = 12.0; speed_mps >= 0.0; speed_mps -= 3.0) {
        outage.scene().set_speed("h1", core::MetresPerSecond(speed_mps));
        outage.pass(1.0, "a1");
    }
    outage.pass(15.0, "a1");
}

TEST(CarFollowing, StopsADarkVehicleBehindALeaderThatBrakes) {
    Outage outage(in_line);
    brake(outage);
    // h1 stood still at 85 m with its rear at 80 m; the gap at standstill is 2.5 m.
    ASSERT_NEAR(outage.x_m("h1"), 85.0F, 0.01F);
    EXPECT_NEAR(outage.believed("a1").x_m, 77.5F, 1.0F);
    EXPECT_LT(outage.believed("a1").speed_mps, 0.3F);
    Outage blind(in_line, {{"follow_leaders", "0"}});
    brake(blind);
    EXPECT_GT(blind.believed("a1").x_m, 300.0F) << "nothing else may have stopped it";
}

TEST(CarFollowing, KeepsTheGapThatItsHeadwaySays) {
    float gap_m[2] = {};
    const char* const headways[] = {"1", "2"};
    for (int at = 0; at < 2; ++at) {
        Outage outage(in_line, {{"headway_s", headways[at]}});
        outage.scene().set_speed("h1", core::MetresPerSecond(10.0));
        outage.pass(30.0, "a1");
        gap_m[at] = outage.x_m("h1") - 5.0F - outage.believed("a1").x_m;
        EXPECT_NEAR(outage.believed("a1").speed_mps, 10.0F, 0.3F);
    }
    // (s0 + v T) / sqrt(1 - (v / v0)^4), v = v0 / 2.
    EXPECT_NEAR(gap_m[0], 12.5F / std::sqrt(1.0F - 1.0F / 16.0F), 1.0F);
    EXPECT_NEAR(gap_m[1], 22.5F / std::sqrt(1.0F - 1.0F / 16.0F), 1.0F);
}

TEST(CarFollowing, WaitsAtRedAndStartsAgainAtGreen) {
    Outage outage(at_the_line);
    outage.pass(10.0, "a1");
    EXPECT_NEAR(outage.believed("a1").x_m, 79.0F, 1.0F) << "it comes up to the line";
    outage.show('G');
    outage.pass(6.0, "a1");
    // From standstill at up to 2.6 m/s^2 in 6 s: 46.8 m at most.
    EXPECT_GT(outage.believed("a1").x_m, 110.0F);
    EXPECT_LT(outage.believed("a1").x_m, 79.0F + 46.8F);
    Outage blind(at_the_line, {{"obey_signals", "0"}});
    blind.pass(10.0, "a1");
    EXPECT_GT(blind.believed("a1").x_m, 120.0F);
}

TEST(CarFollowing, BrakesBeforeARedLightAhead) {
    Outage outage(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a............|r.....
    )");
    outage.pass(20.0, "a1");
    EXPECT_NEAR(outage.believed("a1").x_m, 129.0F, 1.0F);
    EXPECT_LT(outage.believed("a1").speed_mps, 0.3F);
}

TEST(CarFollowing, PassesYellowWhereItCannotStop) {
    // 15 m before the line at 20 m/s: stopping takes 13.3 m/s^2.
    constexpr const char* near = "10 m per cell, limit 20 m/s, speed 20 m/s\n.a.|y..................";
    Outage late(near);
    late.pass(3.0, "a1");
    EXPECT_NEAR(late.believed("a1").x_m, 75.0F, 1.0F);
    // 55 m before it: 3.6 m/s^2.
    constexpr const char* far = "10 m per cell, limit 20 m/s, speed 20 m/s\n.a.....|y..............";
    Outage early(far);
    early.pass(15.0, "a1");
    EXPECT_LT(early.believed("a1").x_m, 70.0F);
}

TEST(CarFollowing, FollowsADarkLeaderAcrossAJunction) {
    // h1 stands beyond the junction and is dark, too: both are twins, and only h1 knows why it stands.
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 0 m/s
        .a.....|G......h..|r......
    )");
    const auto predictor = make_predictor("car_following", {scene.network(), {}, "", {}});
    traffic::BelievedGraph belief;
    predictor->predict(support::perfect_observation(scene), belief);
    predictor->predict(testing::after_outage(scene, 60.0, {"a1", "h1"}), belief);
    const float leader_m = belief.find(scene.key("h1"))->state.x_m;
    EXPECT_NEAR(leader_m, 159.0F, 1.0F);
    EXPECT_NEAR(belief.find(scene.key("a1"))->state.x_m, leader_m - 7.5F, 1.0F);
}

TEST(CarFollowing, PutsAVehicleWhereItReports) {
    Outage outage(in_line);
    outage.pass(8.0, "a1");
    EXPECT_NE(outage.believed("a1").x_m, outage.x_m("a1"));
    outage.scene().set_speed("a1", core::MetresPerSecond(3.0));
    outage.see();
    EXPECT_EQ(outage.believed("a1").x_m, outage.x_m("a1"));
    EXPECT_EQ(outage.believed("a1").speed_mps, 3.0F);
    const float reported_m = outage.x_m("a1");
    outage.pass(1.0, "a1");
    EXPECT_NEAR(outage.believed("a1").x_m, reported_m + 3.0F + 1.3F, 0.5F) << "it goes on from there";
}

TEST(CarFollowing, LetsVehiclesLeaveOnlyWhereExitsAreUnknown) {
    for (const bool known : {true, false}) {
        Outage outage("10 m per cell, limit 20 m/s, speed 20 m/s\na.........\ne.........");
        outage.know_exits(known);
        outage.pass(3.0, "a1");
        EXPECT_TRUE(outage.is_believed("a1"));
        outage.pass(30.0, "a1");
        EXPECT_EQ(outage.is_believed("a1"), known);
        if (!known) continue;
        EXPECT_NEAR(outage.believed("a1").x_m, 100.0F, 0.1F) << "at the end of its route";
    }
}

TEST(CarFollowing, GoesStraightOnWhereNoRouteIsKnown) {
    support::Scene scene(testing::side_by_side);
    traffic::Observation observation = testing::after_outage(scene, 5.0, {"a1"});
    const traffic::Roster nobody;
    for (const bool listed : {true, false}) {
        // Either nobody knows the route, or the report says to be beyond it.
        if (!listed) observation.roster = &nobody;
        observation.vehicles[scene.row("a1")].state.lane =
            listed ? core::LaneIndex::none() : observation.vehicles[scene.row("e1")].state.lane;
        const auto predictor = make_predictor("car_following", {scene.network(), {}, "", {}});
        traffic::BelievedGraph belief;
        predictor->predict(observation, belief);
        EXPECT_NEAR(belief.find(scene.key("a1"))->state.x_m, 135.0F, 1e-3F) << "5 s at 20 m/s";
    }
}

TEST(CarFollowing, ChangesToALaneThatLeadsOn) {
    constexpr const char* lane_drop = R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ..a...............+####################
        ...e..............+....................
    )";
    Outage outage(lane_drop);
    outage.pass(3.0, "a1");
    EXPECT_EQ(outage.scene().network().lane(outage.believed("a1").lane).number, 0U);
    // With the only way on full of vehicles that stand, it waits at the end of its own lane.
    Outage full(R"(
        10 m per cell, limit 20 m/s, speed 0 m/s
        ..a.......+####################
        ..hhhhhhhh+h...................
    )");
    full.scene().set_speed("a1", core::MetresPerSecond(15.0));
    full.see();
    full.pass(20.0, "a1");
    EXPECT_LT(full.believed("a1").x_m, 105.0F);
}

TEST(CarFollowing, DrivesAlikeHoweverOftenItIsAsked) {
    float place_m[2] = {};
    const double intervals_s[] = {0.5, 2.0};
    for (int at = 0; at < 2; ++at) {
        Outage outage("10 m per cell, limit 20 m/s, speed 5 m/s\na..............................");
        outage.pass(8.0, "a1", intervals_s[at]);
        place_m[at] = outage.believed("a1").x_m;
    }
    EXPECT_NEAR(place_m[0], place_m[1], 1e-3F);
    EXPECT_GT(place_m[0], 5.0F + 8.0F * 5.0F + 20.0F) << "it gained speed";
}

TEST(CarFollowing, StartsAnewWithAnObservationOfAnotherRun) {
    Outage outage(in_line);
    const traffic::Observation first = support::perfect_observation(outage.scene());
    outage.pass(10.0, "a1");
    outage.ask(first);
    EXPECT_EQ(outage.believed("a1").x_m, 5.0F);
}

TEST(CarFollowing, EstimatesWhatADriverShowed) {
    float place_m[2] = {};
    const char* const estimates[] = {"0", "1"};
    for (int at = 0; at < 2; ++at) {
        Outage outage(
            "10 m per cell, limit 20 m/s, speed 24 m/s\na.............................................",
            {{"estimate", estimates[at]}});
        for (int second = 0; second < 5; ++second) {
            outage.scene().pass(core::Seconds(1.0));
            outage.see();
        }
        const float seen_m = outage.x_m("a1");
        outage.pass(8.0, "a1");
        place_m[at] = outage.believed("a1").x_m - seen_m;
    }
    EXPECT_LT(place_m[0], 185.0F) << "24 m/s is above the limit, to which it slows down";
    EXPECT_NEAR(place_m[1], 8.0F * 24.0F, 3.0F);
}

/// How far a driver is believed to get in 8 s in the dark, who was seen at one speed for half a minute, m.
float believed_way_m(int speed_mps, const char* estimate) {
    Outage outage(
        "10 m per cell, limit 20 m/s, speed " + std::to_string(speed_mps) + " m/s\na" + std::string(79, '.'),
        {{"estimate", estimate}});
    for (int second = 0; second < 30; ++second) {
        outage.scene().pass(core::Seconds(1.0));
        outage.see();
    }
    const float seen_m = outage.x_m("a1");
    outage.pass(8.0, "a1");
    return outage.believed("a1").x_m - seen_m;
}

TEST(CarFollowing, EstimatesThatADriverWantsNoMoreOnlyFromOneThatIsSteadyAndNotFarBelowTheLimit) {
    EXPECT_GT(believed_way_m(17, "0"), 145.0F) << "speeds up to the limit";
    EXPECT_NEAR(believed_way_m(17, "1"), 8.0F * 17.0F, 5.0F) << "85 % of the limit is what it wants";
    EXPECT_EQ(believed_way_m(12, "1"), believed_way_m(12, "0")) << "60 % may be owed to the traffic";
}

TEST(CarFollowing, RefusesSettingsOutOfRange) {
    const support::Scene scene(in_line);
    const auto refused = [&](const core::Settings& settings) {
        try {
            make_predictor("car_following", {scene.network(), {}, "", {}}, settings);
        } catch (const core::InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    EXPECT_THAT(refused({{"headway_s", "0"}}), AllOf(HasSubstr("headway_s"), HasSubstr("0.1 to 5")));
    EXPECT_THAT(refused({{"min_gap_m", "-1"}}), HasSubstr("min_gap_m"));
    EXPECT_THAT(refused({{"speed_factor", "30"}}), HasSubstr("0.2 to 3"));
    EXPECT_THAT(refused({{"follow_leaders", "2"}}), HasSubstr("0 to 1"));
    EXPECT_THAT(refused({{"estimate", "0.5"}}), HasSubstr("not a whole number"));
    EXPECT_THAT(refused({{"headway", "1"}}), HasSubstr("headway_s"));
    EXPECT_EQ(refused({{"headway_s", "1.3"}}), "accepted");
}

TEST(IdmDriver, HasItsEquilibriumWhereThePaperSays) {
    const IdmDriver driver{1.4F, 2.0F, 1.5F, 2.0F, 4.0F};
    EXPECT_FLOAT_EQ(driver.free(0.0F, 30.0F), 1.4F);
    EXPECT_FLOAT_EQ(driver.free(30.0F, 30.0F), 0.0F);
    const float equilibrium_m = (2.0F + 15.0F * 1.5F) / std::sqrt(1.0F - 1.0F / 16.0F);
    EXPECT_NEAR(driver.free(15.0F, 30.0F) - driver.interaction(15.0F, equilibrium_m, 0.0F), 0.0F, 1e-5F);
    // s* = 2 + 10 x 1.5 + 10 x 5 / (2 sqrt(2.8)) = 31.94 m at a gap of 20 m.
    EXPECT_NEAR(driver.interaction(10.0F, 20.0F, 5.0F), 1.4F * std::pow(31.94F / 20.0F, 2.0F), 1e-2F);
    EXPECT_FLOAT_EQ(driver.interaction(0.0F, 2.0F, -5.0F), 1.4F) << "who parts is not drawn along";
}

float twin_link_probability(float room_m, float sensor_spread_m, float spread_m,
                            const CarFollowingConfig& config) {
    return probability_from_logit(twin_link_logit(room_m, sensor_spread_m, spread_m, config));
}

TEST(TwinLinkLogit, IsEvenAtTheRadiusAndLessSureWithAge) {
    const CarFollowingConfig config;
    const auto probability = [&](float room_m, float one_s, float other_s) {
        return twin_link_probability(room_m, 0.0F, twin_spread_m(one_s, other_s, config), config);
    };
    EXPECT_FLOAT_EQ(probability(0.0F, 5.0F, 0.0F), 0.5F);
    EXPECT_NEAR(probability(10.0F, 5.0F, 0.0F) + probability(-10.0F, 5.0F, 0.0F), 1.0F, 1e-6F);
    EXPECT_GT(probability(10.0F, 5.0F, 0.0F), probability(10.0F, 20.0F, 0.0F));
    EXPECT_GT(probability(10.0F, 20.0F, 0.0F), probability(10.0F, 20.0F, 20.0F));
    EXPECT_EQ(probability(10.0F, 5.0F, 20.0F), probability(10.0F, 20.0F, 5.0F));
    EXPECT_EQ(probability(1.0F, 0.0F, 0.0F), 1.0F) << "both new and exact";
    EXPECT_EQ(probability(-1.0F, 0.0F, 0.0F), 0.0F);
}

TEST(TwinLinkLogit, AddsTheDoubtsOfSensors) {
    const CarFollowingConfig config;
    EXPECT_NEAR(twin_link_probability(4.0F, 2.0F, 0.0F, config), 1.0 / (1.0 + std::exp(-2.0)), 1e-5);
    const float spread_m = twin_spread_m(10.0F, 0.0F, config);
    const float motion = twin_link_probability(4.0F, 0.0F, spread_m, config);
    EXPECT_LT(twin_link_probability(4.0F, 2.0F, spread_m, config), motion);
    EXPECT_NEAR(twin_link_probability(4.0F, 1e-6F, spread_m, config), motion, 1e-4);
}

TEST(RouteRule, StartsAVehicleAgainThatWasSeenStandingBeforeTheLightTurnedGreen) {
    Outage outage(at_the_line, {}, "route_rule");
    outage.pass(5.0, "a1");
    EXPECT_NEAR(outage.believed("a1").x_m, 75.0F, 0.1F) << "red: it stays";
    outage.show('G');
    outage.pass(9.0, "a1");
    EXPECT_GT(outage.believed("a1").x_m, 100.0F);
    Outage before(at_the_line, {{"start_acceleration_mps2", "0"}}, "route_rule");
    before.pass(5.0, "a1");
    before.show('G');
    before.pass(9.0, "a1");
    EXPECT_NEAR(before.believed("a1").x_m, 75.0F, 0.1F);
}

TEST(RouteRule, HoldsAStartedVehicleAtTheNextRedLight) {
    Outage outage(R"(
        10 m per cell, limit 20 m/s, speed 0 m/s
        .......a|r....|r........................
    )",
                  {}, "route_rule");
    outage.show('G');
    outage.pass(30.0, "a1");
    EXPECT_NEAR(outage.believed("a1").x_m, 120.0F, 0.1F);
}

}  // namespace
}  // namespace clearway::prediction
