#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "actuation/signal_watch.hpp"

namespace clearway::testing {
namespace {

class SignalLease : public ::testing::TestWithParam<double> {};

TEST_P(SignalLease, clears_with_yellow_and_all_red_holds_and_comes_back_the_same_way) {
    const double step_s = GetParam();
    ActuationBench bench(step_s);
    const auto history = watch(bench, 40.0, hold_until(west, 15.0));
    ASSERT_EQ(history.size(), 7U);
    EXPECT_EQ(history[1].state, "Gyyyrrrryyyyrrrr") << "the right turn from the north crosses nobody";
    EXPECT_EQ(history[2].state, "Grrrrrrrrrrrrrrr");
    EXPECT_EQ(history[3].state, "GrrrGrrrrrrrGGGG");
    EXPECT_EQ(history[4].state, "Grrryrrrrrrryyyy") << "the program goes on with a green of the right turn";
    EXPECT_EQ(history[5].state, "Grrrrrrrrrrrrrrr");
    EXPECT_EQ(history[6].state, history[0].state);
    const auto lasted = [&](int row) { return history[row + 1].from_s - history[row].from_s; };
    for (const int yellow : {1, 4}) {
        EXPECT_GE(lasted(yellow), 3.0 - 1e-9);
        EXPECT_LT(lasted(yellow), 3.0 + step_s - 1e-9);
    }
    for (const int red : {2, 5}) {
        EXPECT_GE(lasted(red), 1.5 - 1e-9);
        EXPECT_LT(lasted(red), 1.5 + step_s - 1e-9);
    }
    EXPECT_EQ(bench.actuator.active(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Steps, SignalLease, ::testing::Values(0.1, 0.25, 1.0));

TEST(SignalHold, of_what_is_green_already_starts_at_once) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::HoldGreen{{1, 2}}, 2.0);
    const std::string before = bench.shown[0];
    const auto first = bench.only<traffic::SetSignalState>(bench.step());
    ASSERT_EQ(first.size(), 1U);
    EXPECT_EQ(first[0].state, "GGGgrrrrGGGyrrrr") << "only the left turn across it clears";
    EXPECT_EQ(before, "GGGgrrrrGGGgrrrr");
}

TEST(SignalHold, that_nothing_conflicts_with_changes_no_letter) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::HoldGreen{{0}}, 1.0);
    const auto history = watch(bench, 0.75, [](ActuationBench&) {});
    EXPECT_EQ(history.size(), 1U);
}

TEST(SignalHold, that_lapses_during_the_yellow_still_clears_before_the_program_returns) {
    ActuationBench bench;
    const auto history = watch(bench, 20.0, hold_until(west, 0.5));
    for (const Shown& shown : history) {
        EXPECT_EQ(shown.state.find("GGGG"), std::string::npos) << "never granted";
    }
    EXPECT_EQ(history.back().state, history.front().state);
    EXPECT_EQ(bench.actuator.active(), 0U);
}

TEST(SignalHold, ends_at_the_cap_and_may_start_again_after_a_cycle) {
    ActuationBench bench;
    double left_s = 0.0;
    double returned_s = 0.0;
    double again_s = 0.0;
    watch(bench, 180.0, [&](ActuationBench& b) {
        const auto signals = b.actuator.signals();
        const bool runs = signals.empty() || signals[0].stage == traffic::SignalStage::program;
        if (left_s == 0.0 && !signals.empty() && signals[0].capped) left_s = b.now.value;
        if (left_s > 0.0 && returned_s == 0.0 && runs) returned_s = b.now.value;
        if (returned_s > 0.0 && again_s == 0.0 && !runs) again_s = b.now.value;
        b.offer(signal_a, traffic::HoldGreen{west}, 2.0);
    });
    EXPECT_NEAR(left_s, 60.25, 0.3);
    EXPECT_LE(returned_s, left_s + 4.5 + 0.3);
    EXPECT_NEAR(again_s, returned_s + 90.0, 0.3) << "41 + 4 + 41 + 4 s: everybody has had green";
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.at(Refusal::hold_cap), 1U);
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.at(Refusal::lockout), 1U);
}

TEST(SignalHold, that_ended_by_itself_may_start_again_after_the_cool_down) {
    ActuationBench bench;
    double returned_s = 0.0;
    double again_s = 0.0;
    watch(bench, 40.0, [&](ActuationBench& b) {
        const bool in_program = b.shown[0] == two_crossings().signals()[0].program[0].state;
        if (b.now.value > 10.0 && in_program && returned_s == 0.0) returned_s = b.now.value;
        if (returned_s > 0.0 && !in_program && again_s == 0.0) again_s = b.now.value;
        if (b.now.value < 5.0 || returned_s > 0.0) b.offer(signal_a, traffic::HoldGreen{west}, 2.0);
    });
    EXPECT_NEAR(again_s, returned_s + 10.0, 0.3);
}

TEST(SignalHold, has_a_cap_of_its_own_when_it_takes_over_from_one_that_conflicts) {
    ActuationBench bench;
    double ended_s = 0.0;
    const auto history = watch(bench, 130.0, [&](ActuationBench& b) {
        const auto signals = b.actuator.signals();
        if (ended_s == 0.0 && !signals.empty() && signals[0].capped) ended_s = b.now.value;
        if (b.now.value < 40.0)
            b.offer(signal_a, traffic::HoldGreen{west}, 2.0, 0, "policy", core::VehicleKey{1});
        if (b.now.value > 20.0)
            b.offer(signal_a, traffic::HoldGreen{north}, 2.0, 0, "policy", core::VehicleKey{2});
    });
    double taken_over_s = 0.0;
    for (const Shown& shown : history)
        if (shown.state == "GrrrGrrrrrrryyyy") taken_over_s = shown.from_s;
    EXPECT_NEAR(taken_over_s, 41.75, 0.6);
    EXPECT_NEAR(ended_s, taken_over_s + 60.0, 0.5) << "not 60 s after the first took it";
}

TEST(SignalHold, ends_a_green_when_nobody_on_it_could_just_stop_or_2_s_later) {
    // 8 m/s stop within 7.1 m at 4.5 m/s2; who reacts for half a second and keeps 1 m needs 12.1 m.
    const auto yellow_begins_s = [](double before_line_m, double leaves_s) {
        ActuationBench bench;
        const auto vehicle = bench.add(
            {"h", traffic::VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 289.6 - before_line_m, 8.0});
        const auto history = watch(bench, 4.0, [&](ActuationBench& b) {
            hold_until(west, 1000.0)(b);
            if (b.now.value >= leaves_s) b.on_road.erase(vehicle);
        });
        return history.at(1).from_s;
    };
    EXPECT_NEAR(yellow_begins_s(10.0, 1.0), 1.25, 1e-9);
    EXPECT_NEAR(yellow_begins_s(10.0, 100.0), 2.25, 1e-9);
    EXPECT_NEAR(yellow_begins_s(6.0, 100.0), 0.25, 1e-9) << "it drives on";
    EXPECT_NEAR(yellow_begins_s(14.0, 100.0), 0.25, 1e-9) << "it stops in comfort";
}

TEST(SignalHold, waits_for_a_gap_before_it_gives_its_own_green_back) {
    ActuationBench bench;
    bench.add({"h", traffic::VehicleClass::human, {"west_A", "A_B"}, 0, line_m - 10.0, 8.0});
    double ends_s = 0.0;
    watch(bench, 20.0, [&](ActuationBench& b) {
        if (b.now.value < 10.0) b.offer(signal_a, traffic::HoldGreen{west}, 0.5);
        if (ends_s == 0.0 && b.shown[0][west[1]] == 'y') ends_s = b.now.value;
    });
    EXPECT_NEAR(ends_s, 10.25 + 2.0, 1e-9) << "it ended at 10.25 s";
}

TEST(SignalHold, for_two_emergency_vehicles_serves_priority_then_age_then_the_other) {
    ActuationBench bench;
    const core::VehicleKey first{1};
    const core::VehicleKey second{2};
    const auto history = watch(bench, 30.0, [&](ActuationBench& b) {
        if (b.now.value < 8.0) b.offer(signal_a, traffic::HoldGreen{west}, 2.0, 0, "policy", first);
        if (b.now.value < 18.0) b.offer(signal_a, traffic::HoldGreen{north}, 2.0, 0, "policy", second);
    });
    std::vector<std::string> greens;
    for (const Shown& shown : history) {
        if (shown.state == "GrrrGrrrrrrrGGGG" || shown.state == "GGGGGrrrGrrrrrrr")
            greens.push_back(shown.state);
    }
    ASSERT_EQ(greens.size(), 2U);
    EXPECT_EQ(greens[0], "GrrrGrrrrrrrGGGG");
    EXPECT_EQ(greens[1], "GGGGGrrrGrrrrrrr");
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.at(Refusal::outranked), 1U);
}

TEST(SignalHold, of_higher_priority_wins_over_an_earlier_one) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::HoldGreen{west}, 20.0, 0, "policy", core::VehicleKey{1});
    bench.offer(signal_a, traffic::HoldGreen{north}, 20.0, 5, "policy", core::VehicleKey{2});
    bench.run_until(10.0);
    EXPECT_EQ(bench.shown[0], "GGGGrrrrGrrrrrrr");
}

const traffic::HoldGreen from_north{north, {1, 2}};
const traffic::HoldGreen from_south{{8, 9, 10, 11}, {9, 10}};

TEST(SignalHold, for_two_that_only_pass_each_other_shows_the_phase_that_serves_both) {
    ActuationBench bench;
    bench.offer(signal_a, from_north, 30.0, 0, "policy", core::VehicleKey{1});
    bench.run_until(10.0);
    EXPECT_EQ(bench.shown[0], "GGGGrrrrGrrrrrrr") << "alone its approach yields to nobody";
    bench.offer(signal_a, from_south, 20.0, 0, "policy", core::VehicleKey{2});
    bench.run_until(20.0);
    EXPECT_EQ(bench.shown[0], "GGGgrrrrGGGgrrrr") << "left turns from both sides yield";
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.size(), 0U);
}

TEST(SignalHold, opens_at_once_before_a_left_turn_that_yields_already) {
    ActuationBench bench;
    bench.shown[0] = "GGGgrrrrrrrrrrrr";
    bench.offer(signal_a, from_north, 30.0, 0, "policy", core::VehicleKey{1});
    bench.offer(signal_a, from_south, 30.0, 0, "policy", core::VehicleKey{2});
    bench.step();
    EXPECT_EQ(bench.shown[0], "GGGgrrrrGGGgrrrr");
}

TEST(SignalHold, for_one_that_turns_left_stays_protected_when_another_comes_from_the_other_side) {
    for (const std::uint16_t own : {std::uint16_t{8}, std::uint16_t{11}}) {
        ActuationBench bench;
        bench.offer(signal_a, traffic::HoldGreen{north, {3}}, 20.0, 0, "policy", core::VehicleKey{1});
        bench.offer(signal_a, traffic::HoldGreen{{8, 9, 10, 11}, {own}}, 20.0, 0, "policy",
                    core::VehicleKey{2});
        bench.run_until(10.0);
        EXPECT_EQ(bench.shown[0], "GGGGrrrrGrrrrrrr") << own;
        EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.at(Refusal::outranked), 1U) << own;
    }
}

TEST(SignalHold, of_one_that_is_stuck_ends_at_its_cap_though_others_join_and_leave) {
    ActuationBench bench;
    watch(bench, 75.0, [&](ActuationBench& b) {
        const double now_s = b.now.value;
        b.offer(signal_a, from_north, 2.0, 0, "policy", core::VehicleKey{1});
        if (now_s > 30.0 && now_s < 40.0)
            b.offer(signal_a, from_south, 2.0, 0, "policy", core::VehicleKey{2});
    });
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.count(Refusal::hold_cap), 1U);
}

TEST(SignalHold, for_two_whose_own_ways_cross_serves_one_though_a_phase_has_both) {
    ActuationBench bench;
    const traffic::HoldGreen left_from_north{north, {3}};
    bench.offer(signal_a, left_from_north, 20.0, 0, "policy", core::VehicleKey{1});
    bench.offer(signal_a, from_south, 20.0, 0, "policy", core::VehicleKey{2});
    bench.run_until(10.0);
    EXPECT_EQ(bench.shown[0], "GGGGrrrrGrrrrrrr");
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.at(Refusal::outranked), 1U);
}

TEST(SignalHold, that_is_served_beside_the_first_goes_on_before_one_that_waited_longer) {
    ActuationBench bench;
    const auto history = watch(bench, 40.0, [&](ActuationBench& b) {
        const double now_s = b.now.value;
        if (now_s < 8.0) b.offer(signal_a, from_north, 1.0, 0, "policy", core::VehicleKey{1});
        if (now_s >= 2.0 && now_s < 26.0)
            b.offer(signal_a, traffic::HoldGreen{west}, 1.0, 0, "policy", core::VehicleKey{3});
        if (now_s >= 4.0 && now_s < 14.0)
            b.offer(signal_a, from_south, 1.0, 0, "policy", core::VehicleKey{2});
        if (now_s >= 9.0 && now_s < 14.0) {
            EXPECT_EQ(b.shown[0].substr(9, 2), "GG") << now_s;
        }
    });
    EXPECT_TRUE(std::ranges::any_of(history, [](const Shown& shown) {
        return shown.from_s < 26.0 && shown.state.substr(12) == "GGGG";
    })) << "then the third has its turn";
}

TEST(SignalHold, serves_requests_together_that_do_not_conflict) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::HoldGreen{{1, 2}}, 20.0, 0, "policy", core::VehicleKey{1});
    bench.offer(signal_a, traffic::HoldGreen{south_straight}, 20.0, 0, "policy", core::VehicleKey{2});
    bench.run_until(10.0);
    EXPECT_EQ(bench.shown[0].substr(1, 2), "GG");
    EXPECT_EQ(bench.shown[0].substr(9, 2), "GG");
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.size(), 0U);
}

TEST(SignalHold, for_links_that_do_not_exist_is_refused) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::HoldGreen{{16}});
    bench.offer(signal_a, traffic::HoldGreen{{}});
    bench.offer(core::SignalIndex{99}, traffic::HoldGreen{{0}});
    bench.offer(core::SignalIndex::none(), traffic::HoldGreen{{0}});
    EXPECT_TRUE(bench.step().empty());
    bench.offer(signal_a, traffic::HoldGreen{{0}, {99}}, 2.0, 0, "policy", core::VehicleKey{1});
    bench.offer(signal_a, traffic::HoldGreen{{0}, {1}}, 2.0, 0, "policy", core::VehicleKey{2});
    EXPECT_TRUE(bench.step().empty());
    const auto& refused = bench.counts(LeaseKind::hold_green).refused;
    EXPECT_EQ(refused.at(Refusal::own_link_not_held), 2U);
    EXPECT_EQ(refused.at(Refusal::no_such_link), 1U);
    EXPECT_EQ(refused.at(Refusal::no_links), 1U);
    EXPECT_EQ(refused.at(Refusal::no_such_signal), 2U);
}

TEST(SignalHold, at_a_signal_that_is_gone_is_dropped) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::HoldGreen{west}, 20.0);
    bench.offer(signal_a, traffic::AdjustGreen{north}, 20.0);
    bench.step();
    bench.shown.clear();
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.at(Refusal::signal_gone), 1U);
    EXPECT_EQ(bench.counts(LeaseKind::adjust_green).refused.at(Refusal::signal_gone), 1U);
    EXPECT_EQ(bench.actuator.active(), 0U);
}

TEST(SignalHold, clears_letters_of_links_that_lead_nowhere_with_the_yellow_of_the_settings) {
    actuation::ActuatorConfig config;
    config.yellow_s = 0.5;
    ActuationBench bench(0.25, config);
    bench.shown[0] += "r";
    bench.step();
    bench.shown[0].back() = 'G';
    std::string letters;
    watch(bench, 2.0, [&](ActuationBench& b) {
        hold_until(west, 1000.0)(b);
        letters += b.shown[0].back();
    });
    EXPECT_EQ(bench.shown[0].size(), 17U);
    EXPECT_EQ(letters, "Gyyrrrr") << "two steps of 0.25 s, and no least green";
}

TEST(SignalHold, writes_only_states_of_legal_length_and_letters) {
    ActuationBench bench(1.0);
    const std::string legal = "GgyrRuosO";
    watch(bench, 60.0, [&](ActuationBench& b) {
        const bool even = static_cast<int>(b.now.value) / 3 % 2 == 0;
        b.offer(signal_a, traffic::HoldGreen{even ? west : north}, 2.5);
        EXPECT_EQ(b.shown[0].size(), 16U);
        EXPECT_EQ(b.shown[0].find_first_not_of(legal), std::string::npos);
    });
}

TEST(SignalHold, waits_for_a_left_turner_inside_the_junction_but_not_for_ever) {
    for (const double leaves_s : {6.0, 100.0}) {
        ActuationBench bench;
        const auto turner =
            bench.add({"h", traffic::VehicleClass::human, {"north_a_A", "A_B"}, 1, 280.0, 0.0});
        bench.on_road[turner].lane = two_crossings().find_lane(":A_3_0").value();
        const auto history = watch(bench, 20.0, [&](ActuationBench& b) {
            hold_until(west, 1000.0)(b);
            if (b.now.value >= leaves_s) b.on_road.erase(turner);
        });
        EXPECT_EQ(history.back().state, "GrrrGrrrrrrrGGGG");
        const double expected_s = leaves_s < 50.0 ? leaves_s + 0.25 : 0.25 + 3.0 + 1.5 + 6.0;
        EXPECT_NEAR(history.back().from_s, expected_s, 0.3);
    }
}

TEST(SignalHold, waits_for_a_turner_who_had_right_of_way_before_it_has_to_yield) {
    ActuationBench bench;
    const auto turner = bench.add({"h", traffic::VehicleClass::human, {"north_a_A", "A_B"}, 1, 280.0, 0.0});
    bench.on_road[turner].lane = two_crossings().find_lane(":A_3_0").value();
    double opens_s = 0.0;
    watch(bench, 25.0, [&](ActuationBench& b) {
        b.offer(signal_a, from_north, 2.0, 0, "policy", core::VehicleKey{1});
        if (b.now.value >= 10.0) b.offer(signal_a, from_south, 2.0, 0, "policy", core::VehicleKey{2});
        if (b.now.value >= 14.0) b.on_road.erase(turner);
        if (opens_s == 0.0 && b.now.value > 10.0 && b.shown[0].substr(9, 2) == "GG") opens_s = b.now.value;
    });
    EXPECT_GE(opens_s, 14.0) << "1.5 s of red alone would end at 11.5";
    EXPECT_LE(opens_s, 14.75);
}

TEST(SignalHold, that_asks_for_another_approach_is_no_longer_the_one_that_has_green) {
    ActuationBench bench;
    bench.offer(signal_a, traffic::HoldGreen{{12}}, 30.0, 0, "policy", core::VehicleKey{1});
    bench.run_until(10.0);
    bench.offer(signal_a, traffic::HoldGreen{west}, 30.0, 0, "policy", core::VehicleKey{2});
    bench.run_until(12.0);
    bench.offer(signal_a, traffic::HoldGreen{south_straight}, 30.0, 0, "policy", core::VehicleKey{1});
    bench.run_until(20.0);
    EXPECT_EQ(bench.shown[0].substr(12), "GGGG") << "the second has it";
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.at(Refusal::outranked), 1U);
}

}  // namespace
}  // namespace clearway::testing
