#include <algorithm>

#include <gtest/gtest.h>

#include "actuation/signal_watch.hpp"

namespace clearway::testing {
namespace {

/// The footway, pedestrians having green, with somebody on the crossing until `left_s`; vehicles from the
/// west are asked green until `asked_s`.
std::vector<Shown> watch_crossing(double left_s, double asked_s, double until_s,
                                  const actuation::Actuator::Config& config = fixed_clearance()) {
    ActuationBench bench(0.25, config, footway());
    bench.shown[0] = "rrG";
    bench.self.walked_on = {*footway().find_lane(":J_c0_0")};
    return watch(bench, until_s, [&](ActuationBench& each) {
        if (each.now.value >= left_s) each.self.walked_on.clear();
        if (each.now.value < asked_s) each.offer(signal_a, traffic::HoldGreen{{1}}, 2.0);
    });
}

TEST(Crossing, turns_red_at_once_and_vehicles_get_green_when_nobody_is_on_it_any_more) {
    const auto slow = watch_crossing(20.0, 30.0, 30.0);
    ASSERT_EQ(slow.size(), 3U);
    EXPECT_EQ(slow[1].state, "rrr") << "pedestrians know no yellow";
    EXPECT_LE(slow[1].from_s, 0.5);
    EXPECT_EQ(slow[2].state, "GGr");
    EXPECT_GE(slow[2].from_s, 20.0);
    EXPECT_LE(slow[2].from_s, 20.5);
    const auto quick = watch_crossing(1.0, 30.0, 30.0);
    ASSERT_EQ(quick.size(), 3U);
    EXPECT_LE(quick[2].from_s, 2.25) << "1.5 s, as between vehicles";
}

TEST(Crossing, with_somebody_who_is_stuck_does_not_hold_up_the_signal_for_ever) {
    actuation::Actuator::Config config = fixed_clearance();
    config.walking_s = 10.0;
    config.hold_cap_s = 600.0;
    const auto history = watch_crossing(1e9, 80.0, 80.0, config);
    ASSERT_EQ(history.size(), 3U);
    EXPECT_NEAR(history[2].from_s, 1.5 + 10.0, 0.75);
}

TEST(Crossing, gets_its_green_back_in_the_phase_to_which_the_hold_returns) {
    const auto& program = footway().signal(signal_a).program;
    const auto walk = std::ranges::find(program, "rrG", &roads::Phase::state);
    ASSERT_NE(walk, program.end());
    actuation::Actuator::Config config = fixed_clearance();
    config.preemption.emplace_back().exit_phase = static_cast<int>(walk - program.begin());
    const auto history = watch_crossing(1.0, 10.0, 40.0, config);
    ASSERT_EQ(history.size(), 6U);
    EXPECT_EQ(history[3].state, "yyr");
    EXPECT_EQ(history[4].state, "rrr");
    EXPECT_EQ(history[5].state, "rrG");
}

class CrossingThatIsRed : public ::testing::TestWithParam<actuation::ClearanceRule> {};

TEST_P(CrossingThatIsRed, but_walked_on_keeps_a_yielding_green_from_priority) {
    ActuationBench bench(0.25, {.clearance = GetParam()}, footway());
    bench.shown[0] = "ggr";
    bench.self.walked_on = {*footway().find_lane(":J_c0_0")};
    const auto history = watch(bench, 10.0, [](ActuationBench& each) {
        if (each.now.value >= 6.0) each.self.walked_on.clear();
        each.offer(signal_a, traffic::HoldGreen{{1}}, 2.0);
    });
    ASSERT_EQ(history.size(), 2U);
    EXPECT_EQ(history[1].state, "gGr");
    EXPECT_GE(history[1].from_s, 6.0);
}

INSTANTIATE_TEST_SUITE_P(Rules, CrossingThatIsRed,
                         ::testing::Values(actuation::ClearanceRule::fixed, actuation::ClearanceRule::ite),
                         [](const auto& rule) { return std::string(core::name(rule.param)); });

TEST(Crossing, has_its_walk_and_the_clearance_of_its_program_though_nobody_is_on_it) {
    const auto history = watch_crossing(0.0, 30.0, 30.0, {});
    ASSERT_EQ(history.size(), 3U);
    EXPECT_EQ(history[1].state, "rrr");
    EXPECT_EQ(history[2].state, "GGr");
    EXPECT_NEAR(history[2].from_s - history[1].from_s, 5.0, 1e-9) << "all red before the cycle begins again";
}

TEST(Crossing, that_has_just_got_green_keeps_it_for_the_time_to_walk) {
    ActuationBench bench(0.25, {}, footway());
    const auto history = watch(bench, 30.0, [](ActuationBench& each) {
        if (each.now.value == 1.0) each.shown[0] = "rrG";
        if (each.now.value >= 2.0) each.offer(signal_a, traffic::HoldGreen{{1}}, 2.0);
        if (each.now.value < 1.0) each.shown[0] = "rrr";
    });
    double walks_s = 0.0;
    double ends_s = 0.0;
    for (const Shown& shown : history) {
        if (shown.state == "rrG") walks_s = shown.from_s;
        if (walks_s > 0.0 && ends_s == 0.0 && shown.state == "rrr") ends_s = shown.from_s;
    }
    EXPECT_NEAR(ends_s - walks_s, 7.0, 0.3);
}

}  // namespace
}  // namespace clearway::testing
