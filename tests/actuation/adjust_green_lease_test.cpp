#include <cmath>

#include <gtest/gtest.h>

#include "actuation/signal_watch.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::testing {
namespace {

TEST(AdjustGreen, starts_the_program_where_most_of_its_links_are_served) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::AdjustGreen{west}, 60.0);
    std::vector<traffic::RestoreProgram> restored;
    for (int step = 0; step < 80; ++step) {
        if (step < 30) bench.offer(signal_a, traffic::HoldGreen{north}, 2.0);
        for (const auto& restore : bench.only<traffic::RestoreProgram>(bench.step())) {
            restored.push_back(restore);
        }
    }
    ASSERT_EQ(restored.size(), 1U);
    EXPECT_EQ(restored[0].phase, 2U);
}

TEST(AdjustGreen, starts_no_phase_of_a_program_that_another_has_replaced) {
    for (const bool held : {true, false}) {
        ActuationBench bench;
        bench.self.program = "another";
        bench.offer(signal_a, traffic::AdjustGreen{west}, 60.0);
        std::vector<traffic::RestoreProgram> restored;
        for (int step = 0; step < 80; ++step) {
            if (held && step < 30) bench.offer(signal_a, traffic::HoldGreen{north}, 2.0);
            for (const auto& restore : bench.only<traffic::RestoreProgram>(bench.step()))
                restored.push_back(restore);
        }
        ASSERT_EQ(restored.size(), held ? 1U : 0U);
        if (held) {
            EXPECT_FALSE(restored[0].phase.has_value()) << "by way of all red";
        }
        EXPECT_EQ(bench.counts(LeaseKind::adjust_green).refused.at(Refusal::unknown_program), 1U);
    }
}

TEST(AdjustGreen, of_what_is_green_needs_no_all_red_on_the_way_back) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::AdjustGreen{north}, 60.0);
    const auto history = watch(bench, 20.0, hold_until(north, 8.0));
    for (const Shown& shown : history)
        EXPECT_EQ(shown.state[1], 'G') << "straight on from the north keeps its green at " << shown.from_s;
    EXPECT_EQ(history.back().state, history.front().state);
}

TEST(AdjustGreen, ends_a_green_that_serves_nobody_it_names_after_its_least_time) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::AdjustGreen{west}, 60.0);
    std::vector<std::pair<double, traffic::RestoreProgram>> sent;
    while (bench.now.value < 12.0) {
        for (const auto& restore : bench.only<traffic::RestoreProgram>(bench.step()))
            sent.emplace_back(bench.now.value, restore);
    }
    ASSERT_FALSE(sent.empty());
    EXPECT_GE(sent[0].first, 10.0);
    EXPECT_EQ(sent[0].second.phase, 1U) << "the yellow of the program itself";
}

/// Where signal A, under a program of its own, goes on after a hold for the north, for links that were asked
/// for then.
std::vector<traffic::RestoreProgram> restored_after_a_hold(const std::string& program,
                                                           const std::vector<std::uint16_t>& asked) {
    const support::TemporaryFolder folder;
    const auto file = folder.write("tls.add.xml", "<additional>" + program + "</additional>");
    const roads::Network network =
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml", {file});
    ActuationBench bench(0.25, fixed_clearance(), network);
    bench.self.program = "own";
    std::vector<traffic::RestoreProgram> restored;
    while (bench.now.value < 40.0) {
        if (bench.now.value < 8.0) bench.offer(signal_a, traffic::HoldGreen{north}, 2.0);
        if (bench.now.value < 12.0) bench.offer(signal_a, traffic::AdjustGreen{asked}, 2.0);
        for (const auto& restore : bench.only<traffic::RestoreProgram>(bench.step()))
            restored.push_back(restore);
    }
    return restored;
}

TEST(AdjustGreen, goes_on_where_greens_of_the_program_overlap) {
    const auto restored = restored_after_a_hold(R"(
    <tlLogic id="A" type="static" programID="own">
        <phase duration="30" state="GGGgrrrrGGGgrrrr"/><phase duration="4" state="yyyyrrrryyyyGGGg"/>
        <phase duration="30" state="rrrrGGGgrrrrGGGg"/><phase duration="4" state="rrrryyyyrrrryyyy"/>
    </tlLogic>)",
                                                {12, 13});
    ASSERT_EQ(restored.size(), 1U) << "a signal that shows yellow for ever goes back to no program";
    EXPECT_EQ(restored[0].phase, 2U);
}

TEST(AdjustGreen, leaves_a_green_alone_that_serves_it) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::AdjustGreen{north}, 60.0);
    while (bench.now.value < 40.0)
        EXPECT_TRUE(bench.only<traffic::RestoreProgram>(bench.step()).empty());
}

TEST(AdjustGreen, ends_with_its_time) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::AdjustGreen{north}, 2.0);
    bench.run_until(1.75);
    EXPECT_EQ(bench.actuator.active(), 1U);
    bench.run_until(2.0);
    EXPECT_EQ(bench.actuator.active(), 0U);
    EXPECT_EQ(bench.counts(LeaseKind::adjust_green).expired, 1U);
}

TEST(AdjustGreen, starts_a_green_that_vehicles_prolong_with_its_least_time) {
    const auto restored = restored_after_a_hold(R"(
    <tlLogic id="A" type="actuated" programID="own">
        <phase duration="30" minDur="1" state="GGGgrrrrGGGgrrrr"/><phase duration="4" state="yyyyrrrryyyyrrrr"/>
        <phase duration="30" minDur="1" state="rrrrGGGgrrrrGGGg"/><phase duration="4" state="rrrryyyyrrrryyyy"/>
    </tlLogic>)",
                                                west);
    ASSERT_EQ(restored.size(), 1U);
    EXPECT_EQ(restored[0].phase, 2U);
    ASSERT_TRUE(restored[0].lasting.has_value());
    EXPECT_DOUBLE_EQ(restored[0].lasting->value, 10.0) << "least_green_s, not 30 s";
}

TEST(AdjustGreen, leaves_a_program_of_fixed_times_in_step_in_the_end) {
    ActuationBench bench;
    const roads::Signal& signal = two_crossings().signal(signal_a);
    std::size_t phase = 0;
    double ends_s = signal.program[0].duration_s;
    bool in_program = true;
    double cycle_began_s = 0.0;
    while (bench.now.value < 700.0) {
        if (bench.now.value < 20.0) bench.offer(signal_a, traffic::HoldGreen{west}, 2.0);
        if (bench.now.value < 60.0) bench.offer(signal_a, traffic::AdjustGreen{north}, 2.0);
        for (const traffic::Command& command : bench.step()) {
            if (std::holds_alternative<traffic::SetSignalState>(command)) in_program = false;
            const auto* restore = std::get_if<traffic::RestoreProgram>(&command);
            if (restore == nullptr) continue;
            in_program = true;
            ASSERT_TRUE(restore->phase.has_value());
            phase = *restore->phase;
            ends_s = bench.now.value +
                     (restore->lasting ? restore->lasting->value : signal.program[phase].duration_s);
        }
        if (!in_program || bench.now.value < ends_s) continue;
        phase = (phase + 1) % signal.program.size();
        ends_s += signal.program[phase].duration_s;
        bench.shown[0] = signal.program[phase].state;
        if (phase == 0) cycle_began_s = bench.now.value;
    }
    EXPECT_GT(cycle_began_s, 600.0);
    EXPECT_NEAR(std::remainder(cycle_began_s, 90.0), 0.0, 1.0) << "cycles begin at multiples of 90 s";
}

TEST(AdjustGreen, that_lapses_while_it_waits_for_a_gap_leaves_the_next_one_its_own_wait) {
    ActuationBench bench;
    bench.add({"h", traffic::VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 289.6 - 10.0, 8.0});
    double ended_s = 0.0;
    while (bench.now.value < 40.0 && ended_s == 0.0) {
        const double now_s = bench.now.value;
        const bool wants_west = now_s < 11.0 || now_s >= 30.0;
        bench.offer(signal_a, traffic::AdjustGreen{wants_west ? west : north}, 0.4);
        for (const auto& restore : bench.only<traffic::RestoreProgram>(bench.step()))
            if (restore.phase == 1U) ended_s = bench.now.value;
    }
    EXPECT_NEAR(ended_s, 32.0, 0.6) << "2 s after it was asked again, not at once";
}

}  // namespace
}  // namespace clearway::testing
