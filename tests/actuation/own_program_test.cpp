#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "actuation/detail/background_plan.hpp"
#include "support/crossing_scene.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::testing {
namespace {

using actuation::detail::BackgroundPlan;
using actuation::detail::PhaseChange;

/// A cycle of 100 s that begins at 20, 120, 220 s.
roads::Signal clockwork() {
    roads::Signal signal;
    signal.id = "clockwork";
    signal.program = {{56.0, "Gr"}, {4.0, "yr"}, {36.0, "rG"}, {4.0, "ry"}};
    signal.offset_s = 20.0;
    signal.fixed_time = true;
    return signal;
}

constexpr core::Seconds least_green{10.0};

/// Runs the program from phase `phase` at `start_s`, obeying the way back, until its first phase begins for
/// the `cycles`th time; answers when that is, s.
double start_of_cycle(const roads::Signal& signal, std::size_t phase, double start_s, int cycles) {
    BackgroundPlan own(signal, true);
    own.disturb(core::Seconds(0.0));
    double now_s = start_s;
    for (int seen = 0;; phase = (phase + 1) % signal.program.size()) {
        if (phase == 0 && ++seen == cycles) return now_s;
        double lasting_s = signal.program[phase].duration_s;
        own.watch(signal.program[phase].state, core::Seconds(now_s));
        const auto change = own.step_back(least_green, core::Seconds(now_s));
        if (change) {
            EXPECT_EQ(change->phase, phase);
            EXPECT_GE(change->lasting.value, 10.0);
            EXPECT_LE(change->lasting.value, 1.5 * lasting_s);
            lasting_s = change->lasting.value;
        }
        own.watch(signal.program[phase].state, core::Seconds(now_s + 0.25));
        EXPECT_FALSE(own.step_back(least_green, core::Seconds(now_s + 0.25))) << "asked once for each green";
        now_s += lasting_s;
    }
}

class OwnProgramStart : public ::testing::TestWithParam<double> {};

TEST_P(OwnProgramStart, comes_back_into_step_within_two_cycles) {
    const double third_s = start_of_cycle(clockwork(), 2, GetParam(), 3);
    EXPECT_NEAR(std::remainder(third_s - 20.0, 100.0), 0.0, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Lags, OwnProgramStart,
                         ::testing::Values(5.0, 79.0, 80.0, 81.0, 90.0, 110.0, 129.0, 131.0, 160.0));

TEST(BackgroundPlan, in_step_is_left_alone) {
    const roads::Signal signal = clockwork();
    BackgroundPlan own(signal, true);
    own.watch("Gr", core::Seconds(50.0));
    EXPECT_FALSE(own.step_back(least_green, core::Seconds(50.0))) << "nobody disturbed it";
}

TEST(BackgroundPlan, that_nobody_counts_on_is_left_alone) {
    const roads::Signal signal = clockwork();
    BackgroundPlan own(signal, false);
    own.disturb(core::Seconds(0.0));
    EXPECT_TRUE(own.is_in_step(core::Seconds(0.0)));
    own.watch("ry", core::Seconds(46.0));
    own.watch("Gr", core::Seconds(50.0));
    EXPECT_FALSE(own.step_back(least_green, core::Seconds(50.0)));
}

/// Links 0 and 1 of clockwork() are known.
roads::Signal known_clockwork() {
    roads::Signal signal = clockwork();
    signal.links.resize(2);
    signal.crossings = {false, false};
    return signal;
}

constexpr core::Seconds least_rest{5.0};

double owed_8_s(std::uint16_t /*link*/, std::uint32_t /*phase*/) {
    return 8.0;
}

TEST(BackgroundPlan, of_a_fixed_program_goes_on_where_it_would_be) {
    const roads::Signal signal = known_clockwork();
    const BackgroundPlan own(signal, true);
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(220.0 + 40.0)), 0) << "16 s of green are left";
    EXPECT_NEAR(own.resumed_s(0, owed_8_s, least_rest, core::Seconds(220.0 + 46.0)), 10.0, 1e-9)
        << "until it ends in step";
    EXPECT_EQ(own.resumed_s(0, owed_8_s, least_rest, core::Seconds(220.0 + 50.0)), 56.0)
        << "the way back took long: 6 s are too short, the whole green is not";
}

TEST(BackgroundPlan, rest_of_a_green_or_a_yellow_is_left_out) {
    const roads::Signal signal = known_clockwork();
    const BackgroundPlan own(signal, true);
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(220.0 + 50.0)), 2) << "6 s are left of 56";
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(220.0 + 58.0)), 2) << "during yellow";
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(220.0 + 95.0)), 0);
    EXPECT_NEAR(own.resumed_s(2, owed_8_s, least_rest, core::Seconds(220.0 + 55.0)), 41.0, 1e-9)
        << "5 s early";
    EXPECT_NEAR(own.resumed_s(2, owed_8_s, least_rest, core::Seconds(220.0 + 30.0)), 54.0, 1e-9)
        << "half as long again at most";
}

TEST(BackgroundPlan, rest_of_a_phase_in_which_others_clear_is_left_out) {
    roads::Signal signal = known_clockwork();
    signal.links.resize(3);
    signal.crossings = {false, false, false};
    signal.program = {{50.0, "GrG"}, {4.0, "yrG"}, {6.0, "rrG"}, {36.0, "rGG"}, {4.0, "ryG"}};
    const BackgroundPlan own(signal, true);
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(220.0 + 58.0)), 3) << "2 s are left of 6";
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(220.0 + 55.0)), 2) << "5 s are enough";
    EXPECT_EQ(own.resume(owed_8_s, core::Seconds(1.0), core::Seconds(220.0 + 58.0)), 2);
    EXPECT_EQ(own.resumed_s(2, owed_8_s, least_rest, core::Seconds(220.0 + 58.0)), 6.0);
}

TEST(BackgroundPlan, goes_on_with_the_next_phase_when_one_has_just_ended) {
    roads::Signal signal = known_clockwork();
    signal.program = {{30.0, "Gr"}, {30.0, "GG"}, {4.0, "yy"}, {36.0, "rG"}};
    const BackgroundPlan own(signal, true);
    EXPECT_EQ(own.resume(owed_8_s, core::Seconds(0.0), core::Seconds(220.0 + 29.0)), 0);
    EXPECT_EQ(own.resume(owed_8_s, core::Seconds(0.0), core::Seconds(220.0 + 30.0)), 1);
}

TEST(BackgroundPlan, owes_a_link_that_is_always_green_no_more_than_a_cycle) {
    roads::Signal signal = known_clockwork();
    signal.program = {{60.0, "rG"}, {36.0, "GG"}, {4.0, "yG"}};
    const BackgroundPlan own(signal, true);
    const auto owed_200_s = [](std::uint16_t, std::uint32_t) { return 200.0; };
    EXPECT_EQ(own.resume(owed_200_s, least_rest, core::Seconds(220.0)), 0);
    EXPECT_EQ(own.resume(owed_200_s, least_rest, core::Seconds(220.0 + 10.0)), 1) << "90 s are left of it";
}

TEST(BackgroundPlan, that_gives_less_than_is_owed_is_taken_as_it_is) {
    roads::Signal signal = known_clockwork();
    signal.program[2].duration_s = 4.0;
    const BackgroundPlan own(signal, true);
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(20.0 + 50.0)), 2);
}

TEST(BackgroundPlan, that_vehicles_actuate_goes_on_after_the_phase_that_was_left) {
    roads::Signal signal = known_clockwork();
    signal.fixed_time = false;
    BackgroundPlan own(signal, false);
    EXPECT_FALSE(own.resume(owed_8_s, least_rest, core::Seconds(0.0))) << "it was never seen";
    own.watch("Gr", core::Seconds(3.0));
    own.leave();
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(30.0)), 2);
    own.watch("rG", core::Seconds(60.0));
    own.leave();
    EXPECT_EQ(own.resume(owed_8_s, least_rest, core::Seconds(90.0)), 0);
}

TEST(KeepsStep, with_neighbours_near_by_and_fixed_times) {
    const roads::Network& both = two_crossings();
    EXPECT_TRUE(actuation::detail::keeps_step(core::SignalIndex{0}, both)) << "300 m apart";
    const support::TemporaryFolder folder;
    const std::string map = CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml";
    const auto actuated = folder.write("tls.add.xml", R"(<additional>
    <tlLogic id="A" type="actuated" programID="1"><phase duration="9" state="GGGgrrrrGGGgrrrr"/></tlLogic>
</additional>)");
    const roads::Network mixed = roads::Network::read(map, {actuated});
    EXPECT_FALSE(actuation::detail::keeps_step(core::SignalIndex{0}, mixed)) << "it waits for vehicles";
    EXPECT_TRUE(actuation::detail::keeps_step(core::SignalIndex{1}, mixed));
}

/// Two signals of fixed times, the second one this far east and north of the first, which is far from the
/// origin.
roads::Network signals_apart(double east_m, double north_m) {
    std::string roads;
    std::string rest;
    for (const std::string id : {"A", "B"}) {
        const double x_m = id == "A" ? 5000.0 : 5000.0 + east_m;
        const double y_m = id == "A" ? 5000.0 : 5000.0 + north_m;
        roads += fmt::format(R"(
<edge id=":{0}_0" function="internal"><lane id=":{0}_0_0" index="0" speed="9" length="9" shape="{1},{2} {3},{2}"/></edge>
<edge id="in_{0}" from="w_{0}" to="{0}"><lane id="in_{0}_0" index="0" speed="9" length="90" shape="{4},{2} {1},{2}"/></edge>
<edge id="out_{0}" from="{0}" to="e_{0}"><lane id="out_{0}_0" index="0" speed="9" length="90" shape="{3},{2} {5},{2}"/></edge>
<tlLogic id="{0}" type="static" programID="0" offset="0"><phase duration="40" state="G"/><phase duration="9" state="r"/></tlLogic>)",
                             id, x_m, y_m, x_m + 9.0, x_m - 90.0, x_m + 99.0);
        rest += fmt::format(R"(
<junction id="{0}" type="traffic_light" x="{1}" y="{2}" incLanes="in_{0}_0" intLanes=":{0}_0_0" shape="{1},{2}">
<request index="0" response="0" foes="0" cont="0"/></junction>
<connection from="in_{0}" to="out_{0}" fromLane="0" toLane="0" via=":{0}_0_0" tl="{0}" linkIndex="0" dir="s" state="O"/>
<connection from=":{0}_0" to="out_{0}" fromLane="0" toLane="0" dir="s" state="M"/>)",
                            id, x_m, y_m);
    }
    const support::TemporaryFolder folder;
    return roads::Network::read(folder.write(
        "apart.net.xml",
        R"(<net version="1.9"><location netOffset="0,0" convBoundary="0,0,9,9" origBoundary="0,0,9,9" projParameter="!"/>)" +
            roads + rest + "</net>"));
}

TEST(KeepsStep, with_neighbours_within_800_m_in_any_direction) {
    using actuation::detail::keeps_step;
    EXPECT_TRUE(keeps_step(core::SignalIndex{0}, signals_apart(790.0, 0.0)));
    EXPECT_TRUE(keeps_step(core::SignalIndex{1}, signals_apart(0.0, -790.0)));
    EXPECT_FALSE(keeps_step(core::SignalIndex{0}, signals_apart(810.0, 0.0)));
    EXPECT_FALSE(keeps_step(core::SignalIndex{1}, signals_apart(0.0, 810.0)));
    EXPECT_FALSE(keeps_step(core::SignalIndex{0}, signals_apart(700.0, 700.0)));
}

TEST(BackgroundPlan, keeps_short_greens_that_are_shorter_than_the_least_time) {
    roads::Signal signal = clockwork();
    signal.program[2].duration_s = 6.0;
    BackgroundPlan own(signal, true);
    own.disturb(core::Seconds(0.0));
    own.watch("yr", core::Seconds(96.0));
    own.watch("rG", core::Seconds(100.0));
    const auto change = own.step_back(least_green, core::Seconds(100.0));
    ASSERT_TRUE(change.has_value());
    EXPECT_DOUBLE_EQ(change->lasting.value, 6.0) << "20 s late";
}

TEST(BackgroundPlan, never_cuts_the_least_green_of_the_program) {
    roads::Signal signal = clockwork();
    signal.program[2].least_s = 25.0;
    BackgroundPlan own(signal, true);
    own.watch("rG", core::Seconds(100.0));
    own.watch("rG", core::Seconds(124.0));
    EXPECT_FALSE(own.next_after(least_green, core::Seconds(124.0)));
    own.watch("rG", core::Seconds(125.0));
    EXPECT_EQ(own.next_after(least_green, core::Seconds(125.0)), 3U);
    own.disturb(core::Seconds(125.0));
    own.watch("yr", core::Seconds(196.0));
    own.watch("rG", core::Seconds(200.0));
    EXPECT_DOUBLE_EQ(own.step_back(least_green, core::Seconds(200.0)).value().lasting.value, 25.0)
        << "20 s late";
}

TEST(BackgroundPlan, that_is_a_second_late_is_in_step) {
    const roads::Signal signal = clockwork();
    for (const double late_s : {1.0, 1.25}) {
        BackgroundPlan own(signal, true);
        own.disturb(core::Seconds(0.0));
        own.watch("yr", core::Seconds(76.0 + late_s));
        own.watch("rG", core::Seconds(80.0 + late_s));
        EXPECT_EQ(own.step_back(least_green, core::Seconds(80.0 + late_s)).has_value(), late_s > 1.0);
        EXPECT_EQ(own.is_in_step(core::Seconds(80.0 + late_s)), late_s <= 1.0);
    }
}

TEST(BackgroundPlan, gives_up_after_five_cycles) {
    roads::Signal signal = clockwork();
    BackgroundPlan own(signal, true);
    EXPECT_TRUE(own.is_in_step(core::Seconds(0.0)));
    own.disturb(core::Seconds(10.0));
    EXPECT_FALSE(own.is_in_step(core::Seconds(510.0)));
    EXPECT_TRUE(own.is_in_step(core::Seconds(511.0)));
    signal.program.clear();
    BackgroundPlan none(signal, true);
    none.disturb(core::Seconds(10.0));
    EXPECT_TRUE(none.is_in_step(core::Seconds(10.0))) << "without a cycle there is no step";
}

TEST(BackgroundPlan, takes_what_it_sees_first_for_no_start) {
    const roads::Signal signal = clockwork();
    BackgroundPlan own(signal, true);
    own.disturb(core::Seconds(0.0));
    own.watch("Gr", core::Seconds(70.0));
    EXPECT_FALSE(own.step_back(least_green, core::Seconds(70.0)));
    own.watch("yr", core::Seconds(80.0));
    own.watch("rG", core::Seconds(84.0));
    EXPECT_TRUE(own.step_back(least_green, core::Seconds(84.0)));
}

TEST(BackgroundPlan, goes_on_after_a_green_that_has_lasted) {
    const roads::Signal signal = clockwork();
    BackgroundPlan own(signal, true);
    own.watch("rG", core::Seconds(100.0));
    own.watch("rG", core::Seconds(109.0));
    EXPECT_FALSE(own.next_after(least_green, core::Seconds(109.0)));
    own.watch("rG", core::Seconds(110.0));
    EXPECT_EQ(own.next_after(least_green, core::Seconds(110.0)), 3U);
    own.leave();
    own.watch("rG", core::Seconds(111.0));
    EXPECT_FALSE(own.next_after(least_green, core::Seconds(111.0))) << "it starts anew";
}

}  // namespace
}  // namespace clearway::testing
