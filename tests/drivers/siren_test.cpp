#include "drivers/siren.hpp"

#include <gtest/gtest.h>

#include "actuation/fakes.hpp"
#include "support/ascii_scene.hpp"

namespace clearway::testing {
namespace {

const core::KeyedRandom random(core::StudySeed{1}, core::Replication{0});

drivers::SirenConfig everybody() {
    drivers::SirenConfig config;
    config.compliance = 1.0;
    config.reaction_mean_s = 1.0;
    config.reaction_deviation_s = 0.0;
    return config;
}

constexpr const char* two_lanes = R"(
    10 m per cell, limit 20 m/s, speed 10 m/s
    ..e..h.......h.....................
    .....h....a........................
)";

/// What drivers do in `duration`, with steps of 0.5 s.
std::vector<traffic::Command> listen(drivers::Siren& siren, support::Scene& scene, double duration_s,
                                     const FakeSelfKnowledge& self = {}) {
    std::vector<traffic::Command> commands;
    for (double passed_s = 0.0; passed_s < duration_s; passed_s += 0.5) {
        siren.step(scene.snapshot(), scene.roster(), self, commands);
        scene.pass(core::Seconds(0.5));
    }
    return commands;
}

TEST(Siren, makes_the_driver_ahead_leave_the_lane_after_the_reaction_time_and_the_one_beside_stay) {
    support::Scene scene(two_lanes);
    drivers::Siren siren(scene.network(), random, everybody());
    EXPECT_TRUE(listen(siren, scene, 1.0).empty()) << "nobody has reacted yet";
    const auto commands = listen(siren, scene, 1.0);
    const auto lanes = ActuationBench::only<traffic::RequestLane>(commands);
    ASSERT_EQ(lanes.size(), 1U);
    EXPECT_EQ(lanes[0].vehicle, scene.key("h1"));
    EXPECT_EQ(lanes[0].lane_number, 0U);
    const auto freedoms = ActuationBench::only<traffic::SetLaneChangeFreedom>(commands);
    ASSERT_EQ(freedoms.size(), 1U);
    EXPECT_EQ(freedoms[0].vehicle, scene.key("h3"));
    EXPECT_EQ(freedoms[0].freedom, traffic::LaneChangeFreedom::strategic_only);
}

TEST(Siren, is_not_heard_far_ahead_and_moves_no_automated_vehicle) {
    support::Scene scene(two_lanes);
    drivers::Siren siren(scene.network(), random, everybody());
    for (const traffic::Command& command : listen(siren, scene, 5.0)) {
        std::visit(
            [&](const auto& kind) {
                if constexpr (requires { kind.vehicle; }) {
                    EXPECT_NE(kind.vehicle, scene.key("h2"));
                    EXPECT_NE(kind.vehicle, scene.key("a1"));
                }
            },
            command);
    }
}

TEST(Siren, is_off_by_default) {
    support::Scene scene(two_lanes);
    drivers::Siren siren(scene.network(), random, {});
    EXPECT_TRUE(listen(siren, scene, 5.0).empty());
    EXPECT_EQ(siren.aware(), 0U);
}

TEST(Siren, sends_nobody_into_a_lane_that_ends_or_is_taken) {
    support::Scene scene(two_lanes);
    FakeSelfKnowledge self;
    self.outlook[0] = {0, 200.0F, 1};
    drivers::Siren ends(scene.network(), random, everybody());
    EXPECT_TRUE(ActuationBench::only<traffic::RequestLane>(listen(ends, scene, 3.0, self)).empty());
    support::Scene again(two_lanes);
    FakeSelfKnowledge taken;
    taken.room_beside = false;
    drivers::Siren full(again.network(), random, everybody());
    EXPECT_TRUE(ActuationBench::only<traffic::RequestLane>(listen(full, again, 3.0, taken)).empty());
}

TEST(Siren, gives_the_freedom_back_when_it_is_gone) {
    support::Scene scene(two_lanes);
    drivers::Siren siren(scene.network(), random, everybody());
    listen(siren, scene, 2.0);
    scene.set_speed("e1", core::MetresPerSecond(0.0));
    const auto freedoms = ActuationBench::only<traffic::SetLaneChangeFreedom>(listen(siren, scene, 10.0));
    ASSERT_EQ(freedoms.size(), 1U);
    EXPECT_EQ(freedoms[0].freedom, traffic::LaneChangeFreedom::normal);
    EXPECT_EQ(siren.aware(), 0U);
    std::vector<traffic::Command> rest;
    siren.restore_all(rest);
    EXPECT_TRUE(rest.empty());
}

TEST(Siren, is_obeyed_by_the_stated_share_of_drivers_and_always_by_the_same) {
    drivers::SirenConfig half = everybody();
    half.compliance = 0.5;
    half.reaction_mean_s = 0.0;
    const std::string road =
        "10 m per cell, limit 20 m/s, speed 10 m/s\n..eh.................\n.....................\n";
    int obeying = 0;
    for (std::uint32_t replication = 0; replication < 200; ++replication) {
        const core::KeyedRandom driver(core::StudySeed{7}, core::Replication{replication});
        std::vector<std::size_t> counts;
        for (int repeat = 0; repeat < 2; ++repeat) {
            static support::Scene scene(road);
            drivers::Siren siren(scene.network(), driver, half);
            std::vector<traffic::Command> commands;
            siren.step(scene.snapshot(), scene.roster(), FakeSelfKnowledge{}, commands);
            counts.push_back(siren.aware());
        }
        EXPECT_EQ(counts[0], counts[1]);
        obeying += static_cast<int>(counts[0]);
    }
    EXPECT_NEAR(obeying, 100, 30) << "four standard deviations";
}

}  // namespace
}  // namespace clearway::testing
