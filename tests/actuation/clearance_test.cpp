#include "actuation/detail/clearance.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "actuation/detail/link_history.hpp"
#include "actuation/detail/ways.hpp"
#include "actuation/signal_watch.hpp"
#include "core/files.hpp"
#include "support/temporary_folder.hpp"
#include "traffic/signal.hpp"

namespace clearway::testing {
namespace {

using actuation::ClearanceRule;
using actuation::detail::Clearance;
using actuation::detail::LinkHistory;

TEST(ClearanceOfRule, has_the_yellow_that_the_formulas_give_for_a_speed_limit) {
    using actuation::detail::yellow_of_rule_s;
    EXPECT_NEAR(yellow_of_rule_s(ClearanceRule::ite, 50.0 / 3.6), 3.28, 0.005);
    EXPECT_NEAR(yellow_of_rule_s(ClearanceRule::ite, 70.0 / 3.6), 4.19, 0.005);
    EXPECT_DOUBLE_EQ(yellow_of_rule_s(ClearanceRule::ite, 5.0), 3.0);
    EXPECT_DOUBLE_EQ(yellow_of_rule_s(ClearanceRule::ite, 60.0), 7.0);
    EXPECT_DOUBLE_EQ(yellow_of_rule_s(ClearanceRule::rilsa, 50.0 / 3.6), 3.0);
    EXPECT_DOUBLE_EQ(yellow_of_rule_s(ClearanceRule::rilsa, 51.0 / 3.6), 4.0);
    EXPECT_DOUBLE_EQ(yellow_of_rule_s(ClearanceRule::rilsa, 60.0 / 3.6), 4.0);
    EXPECT_DOUBLE_EQ(yellow_of_rule_s(ClearanceRule::rilsa, 61.0 / 3.6), 5.0);
    EXPECT_DOUBLE_EQ(yellow_of_rule_s(ClearanceRule::rilsa, 70.0 / 3.6), 5.0);
}

TEST(ClearanceOfRule, has_the_red_that_the_formulas_give_for_a_crossing) {
    using actuation::detail::red_of_rule_s;
    const actuation::detail::Crossing crossing{20.0, 11.0};
    EXPECT_NEAR(red_of_rule_s(ClearanceRule::ite, crossing, {13.05, false, false}, 3.0), 2.0, 0.001);
    EXPECT_NEAR(red_of_rule_s(ClearanceRule::rilsa, crossing, {13.9, false, false}, 3.0), 1.61, 0.001)
        << "3 + 26 / 10 - 11 / 11.1 - 3";
    EXPECT_NEAR(red_of_rule_s(ClearanceRule::rilsa, crossing, {13.9, true, false}, 3.0), 1.724, 0.001)
        << "2 + 26 / 7 - 11 / 11.1 - 3";
    EXPECT_DOUBLE_EQ(red_of_rule_s(ClearanceRule::rilsa, {0.0, 40.0}, {13.9, false, false}, 3.0), 0.0);
    EXPECT_NEAR(red_of_rule_s(ClearanceRule::rilsa, {12.0, 0.0}, {1.0, false, true}, 0.0), 10.0, 0.001);
    EXPECT_NEAR(red_of_rule_s(ClearanceRule::ite, {10.7, 0.0}, {1.0, false, true}, 0.0), 10.0, 0.001);
    EXPECT_NEAR(red_of_rule_s(ClearanceRule::ite, {3.9, 0.0}, {0.2, false, false}, 0.0), 10.0, 0.001)
        << "a lane on which nobody may drive is left at 1 m/s";
}

TEST(Clearance, of_vehicles_that_enter_late_is_shorter_than_a_second) {
    double shortest_s = 10.0;
    for (const roads::Signal& signal : two_crossings().signals()) {
        const Clearance rilsa({.clearance = ClearanceRule::rilsa}, signal, two_crossings());
        for (std::uint16_t link = 0; link < signal.links.size(); ++link)
            for (std::uint16_t other = 0; other < signal.links.size(); ++other)
                if (signal.foes[link][other]) shortest_s = std::min(shortest_s, rilsa.red_s(link, other));
    }
    EXPECT_LT(shortest_s, 1.0);
}

TEST(Yellow, is_longer_on_a_slippery_road_by_the_braking_that_takes_longer) {
    using actuation::detail::yellow_on_road_s;
    EXPECT_DOUBLE_EQ(yellow_on_road_s(3.0, 1.0), 3.0);
    EXPECT_DOUBLE_EQ(yellow_on_road_s(3.0, 0.5), 5.0) << "1 s of reaction, then 2 s / 0.5";
    EXPECT_DOUBLE_EQ(yellow_on_road_s(5.0, 0.5), 9.0);
    EXPECT_DOUBLE_EQ(yellow_on_road_s(5.0, 0.2), 10.0) << "nobody would believe a longer one";
    EXPECT_DOUBLE_EQ(yellow_on_road_s(12.0, 0.2), 12.0);
    EXPECT_DOUBLE_EQ(yellow_on_road_s(0.5, 0.2), 0.5);
}

TEST(Yellow, of_the_signals_own_program_is_longer_on_a_slippery_road_and_its_red_is_not) {
    const roads::Signal& signal = two_crossings().signals()[0];
    const Clearance dry({}, signal, two_crossings());
    const Clearance wet({.friction = 0.5}, signal, two_crossings());
    EXPECT_DOUBLE_EQ(dry.yellow_s(north[1]), 4.0) << "as the program shows";
    for (std::uint16_t link = 0; link < signal.links.size(); ++link) {
        EXPECT_DOUBLE_EQ(wet.yellow_s(link), 1.0 + (dry.yellow_s(link) - 1.0) / 0.5);
        for (std::uint16_t other = 0; other < signal.links.size(); ++other) {
            EXPECT_DOUBLE_EQ(wet.red_s(link, other), dry.red_s(link, other));
            if (!signal.foes[link][other]) {
                EXPECT_DOUBLE_EQ(dry.red_s(link, other), 0.0);
            }
        }
    }
}

TEST(Clearance, keeps_the_red_of_the_signals_own_program_where_it_is_shorter_than_a_rule_asks) {
    const support::TemporaryFolder folder;
    const auto own_program = folder.write("tls.add.xml", R"(<additional>
    <tlLogic id="A" type="static" programID="own">
        <phase duration="30" state="GGGgrrrrGGGgrrrr"/><phase duration="4" state="yyyyrrrryyyyrrrr"/>
        <phase duration="1" state="rrrrrrrrrrrrrrrr"/>
        <phase duration="30" state="rrrrGGGgrrrrGGGg"/><phase duration="4" state="rrrryyyyrrrryyyy"/>
        <phase duration="1" state="rrrrrrrrrrrrrrrr"/>
    </tlLogic></additional>)");
    const roads::Network network =
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml", {own_program});
    const actuation::ActuatorConfig config{.clearance = ClearanceRule::ite};
    const Clearance ruled(config, two_crossings().signal(signal_a), two_crossings());
    const Clearance own(config, network.signal(signal_a), network);
    EXPECT_GT(ruled.red_s(north[1], west[1]), 1.0);
    EXPECT_DOUBLE_EQ(own.red_s(north[1], west[1]), 1.0);
}

TEST(LinkHistory, knows_since_when_a_link_is_green_or_red) {
    LinkHistory history;
    history.watch("Gr", core::Seconds(0.0));
    EXPECT_GT(history.green_s(0, core::Seconds(1.0)), 1e6) << "nobody saw it begin";
    EXPECT_DOUBLE_EQ(history.red_s(0, core::Seconds(1.0)), 0.0);
    history.watch("yr", core::Seconds(2.0));
    EXPECT_DOUBLE_EQ(history.yellow_s(0, core::Seconds(3.5)), 1.5);
    EXPECT_DOUBLE_EQ(history.yellow_s(1, core::Seconds(3.5)), 0.0);
    EXPECT_DOUBLE_EQ(history.green_s(0, core::Seconds(3.0)), 0.0);
    EXPECT_DOUBLE_EQ(history.red_s(0, core::Seconds(3.0)), 0.0);
    history.watch("rG", core::Seconds(5.0));
    history.watch("rg", core::Seconds(6.0));
    EXPECT_DOUBLE_EQ(history.red_s(0, core::Seconds(7.0)), 2.0);
    EXPECT_DOUBLE_EQ(history.green_s(1, core::Seconds(7.0)), 2.0);
    EXPECT_DOUBLE_EQ(history.green_s(9, core::Seconds(7.0)), 0.0) << "no such link";
    for (const auto time_of : {&LinkHistory::green_s, &LinkHistory::yellow_s, &LinkHistory::red_s})
        EXPECT_DOUBLE_EQ((history.*time_of)(2, core::Seconds(7.0)), 0.0) << "one more than there are";
}

TEST(LinkHistory, counts_from_the_first_letter_of_a_colour) {
    LinkHistory history;
    history.watch("ry", core::Seconds(0.0));
    history.watch("yr", core::Seconds(1.0));
    history.watch("yr", core::Seconds(2.0));
    EXPECT_DOUBLE_EQ(history.yellow_s(0, core::Seconds(3.0)), 2.0);
    EXPECT_DOUBLE_EQ(history.red_s(1, core::Seconds(3.0)), 2.0);
    history.watch("gG", core::Seconds(4.0));
    history.watch("Gg", core::Seconds(5.0));
    EXPECT_DOUBLE_EQ(history.green_s(0, core::Seconds(6.0)), 2.0) << "to take right of way is no new green";
    EXPECT_DOUBLE_EQ(history.green_s(1, core::Seconds(6.0)), 2.0);
}

TEST(SharedArea, of_two_ways_that_cross_begins_and_ends_where_vehicles_would_touch) {
    const roads::Signal& signal = two_crossings().signal(signal_a);
    const auto area = actuation::detail::shared_area(two_crossings(), signal.links[west[1]].front(),
                                                     signal.links[north[1]].front());
    const double whole_m = actuation::detail::length_of_way(two_crossings(), signal.links[west[1]].front());
    EXPECT_GT(area.last_on_first_m, 3.0);
    EXPECT_LT(area.last_on_first_m, whole_m);
    EXPECT_GT(area.first_on_second_m, 3.0);
    EXPECT_TRUE(actuation::detail::turns(two_crossings(), signal.links[west[3]].front()));
    EXPECT_FALSE(actuation::detail::turns(two_crossings(), signal.links[west[1]].front()));
}

TEST(Turns, bend_by_more_than_an_eighth_of_a_circle) {
    const std::string straight = "510.40,295.20 789.60,295.20";
    const std::string text = core::read_file(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml");
    const support::TemporaryFolder folder;
    for (const auto& [bent, is_turn] : {std::pair{"510.40,295.20 587.00,359.48 789.60,295.20", false},
                                        std::pair{"510.40,295.20 574.68,371.80 789.60,295.20", true}}) {
        const roads::Network network = roads::Network::read(folder.write(
            "bent.net.xml", std::string(text).replace(text.find(straight), straight.size(), bent)));
        const roads::SignalLink& way = network.signal(signal_a).links[west[1]].front();
        EXPECT_EQ(actuation::detail::turns(network, way), is_turn) << "by 40 and 50 degrees";
    }
}

TEST(SharedArea, of_a_left_turn_goes_on_behind_the_place_where_it_waits) {
    const roads::Network& network = two_crossings();
    const roads::Signal& signal = network.signal(signal_a);
    const roads::SignalLink& left = signal.links[north[3]].front();
    const auto lanes = actuation::detail::lanes_of_way(network, left);
    ASSERT_EQ(lanes.size(), 2U) << "it waits inside";
    const double waits_m = network.lane(lanes[0]).length_m;
    const double whole_m = waits_m + network.lane(lanes[1]).length_m;
    EXPECT_DOUBLE_EQ(actuation::detail::length_of_way(network, left), whole_m);
    const auto oncoming =
        actuation::detail::shared_area(network, left, signal.links[south_straight[0]].front());
    EXPECT_GT(oncoming.last_on_first_m, waits_m);
    EXPECT_LT(oncoming.last_on_first_m, whole_m);
    const auto merging = actuation::detail::shared_area(network, left, signal.links[west[2]].front());
    EXPECT_NEAR(merging.last_on_first_m, whole_m, 1e-9) << "both end on the same lane";
}

/// Offers holds of either side in turn, some short and some long.
std::vector<Shown> seesaw(actuation::ActuatorConfig config) {
    config.lockout_s = 0.0;
    ActuationBench bench(0.25, config);
    return watch(bench, 400.0, [](ActuationBench& b) {
        const auto round = static_cast<int>(b.now.value / 7.0);
        if (round % 3 == 0) b.offer(signal_a, traffic::HoldGreen{west}, 1.0);
        if (round % 4 == 1) b.offer(signal_a, traffic::HoldGreen{north}, 1.0, 1);
        if (round % 11 == 5) b.offer(signal_a, traffic::HoldGreen{south_straight}, 9.0, 2);
    });
}

/// Letters of one link, run by run, with how long each lasted.
struct Stretch {
    char letter;
    double from_s;
    double to_s;
};

std::vector<Stretch> stretches_of(const std::vector<Shown>& history, std::size_t link) {
    std::vector<Stretch> stretches;
    for (const Shown& shown : history) {
        const char letter = shown.state[link];
        const char kind = traffic::is_green(letter) ? 'G' : traffic::is_yellow(letter) ? 'y' : 'r';
        if (!stretches.empty()) stretches.back().to_s = shown.from_s;
        if (stretches.empty() || stretches.back().letter != kind)
            stretches.push_back({kind, shown.from_s, shown.from_s});
    }
    return stretches;
}

class ConformingHold : public ::testing::TestWithParam<ClearanceRule> {};

TEST_P(ConformingHold, is_never_entered_or_left_faster_than_program_and_rule_allow) {
    actuation::ActuatorConfig config;
    config.clearance = GetParam();
    config.yellow_s = 0.0;
    config.all_red_s = 0.0;
    const std::vector<Shown> history = seesaw(config);
    const roads::Signal& signal = two_crossings().signal(signal_a);
    const Clearance clearance({.clearance = GetParam()}, signal, two_crossings());
    const auto link_count = static_cast<std::uint16_t>(signal.links.size());
    int yellows = 0;
    int openings = 0;
    for (std::uint16_t link = 0; link < link_count; ++link) {
        for (const Stretch& run : stretches_of(history, link)) {
            if (run.from_s == 0.0 || run.to_s == history.back().from_s) continue;
            if (run.letter == 'y') {
                ++yellows;
                EXPECT_GE(run.to_s - run.from_s, 4.0 - 1e-9) << "the program's own; link " << link;
            }
            if (run.letter != 'G') continue;
            EXPECT_GE(run.to_s - run.from_s, 5.0 - 1e-9) << "least green; link " << link;
            for (std::uint16_t other = 0; other < link_count; ++other) {
                if (!signal.foes[link][other]) continue;
                for (const Stretch& before : stretches_of(history, other)) {
                    if (before.letter != 'r' || before.from_s == 0.0) continue;
                    if (before.from_s > run.from_s || before.to_s <= run.from_s) continue;
                    ++openings;
                    EXPECT_GE(run.from_s - before.from_s, clearance.red_s(other, link) - 1e-9)
                        << "link " << link << " after " << other << " at " << run.from_s << " s";
                }
            }
        }
    }
    EXPECT_GT(yellows, 20);
    EXPECT_GT(openings, 20);
}

INSTANTIATE_TEST_SUITE_P(Rules, ConformingHold, ::testing::Values(ClearanceRule::ite, ClearanceRule::rilsa),
                         [](const auto& rule) { return std::string(core::name(rule.param)); });

/// When each link of the west gets green in a hold for them, s.
std::vector<double> openings_s(const actuation::ActuatorConfig& config) {
    ActuationBench bench(0.25, config);
    std::vector<double> opened_s(west.size(), -1.0);
    while (bench.now.value < 40.0) {
        bench.offer(signal_a, traffic::HoldGreen{west}, 2.0);
        bench.step();
        for (std::size_t row = 0; row < west.size(); ++row) {
            if (opened_s[row] < 0.0 && traffic::is_green(bench.shown[0][west[row]]))
                opened_s[row] = bench.now.value;
        }
    }
    return opened_s;
}

TEST(ConformingHold, opens_each_link_when_those_that_conflict_with_it_are_clear) {
    const std::vector<double> opened_s = openings_s({.clearance = ClearanceRule::ite});
    const roads::Signal& signal = two_crossings().signal(signal_a);
    const Clearance clearance({.clearance = ClearanceRule::ite}, signal, two_crossings());
    for (std::size_t row = 0; row < west.size(); ++row) {
        double needs_s = 0.0;
        for (std::uint16_t other = 0; other < signal.links.size(); ++other) {
            const bool loses = traffic::is_green(signal.program[0].state[other]);
            if (loses && signal.foes[other][west[row]])
                needs_s = std::max(needs_s, 4.0 + clearance.red_s(other, west[row]));
        }
        EXPECT_GE(opened_s[row] - 0.25, needs_s - 1e-9) << "link " << west[row];
        EXPECT_LT(opened_s[row] - 0.25, needs_s + 0.25) << "link " << west[row];
    }
    EXPECT_NE(*std::ranges::min_element(opened_s), *std::ranges::max_element(opened_s))
        << "nobody waits for the slowest pair";
}

TEST(ConformingHold, is_not_made_longer_by_the_all_red_of_fixed_transitions) {
    EXPECT_EQ(openings_s({.all_red_s = 10.0}), openings_s({.all_red_s = 0.0}));
    actuation::ActuatorConfig config = fixed_clearance();
    config.all_red_s = 10.0;
    EXPECT_NEAR(openings_s(config)[1], 0.25 + 3.0 + 10.0, 0.3);
}

TEST(ConformingHold, waits_for_a_vehicle_inside_the_junction_where_it_is_in_the_way_but_not_for_ever) {
    for (const double leaves_s : {9.0, 100.0}) {
        ActuationBench bench(0.25, {});
        const auto turner =
            bench.add({"h", traffic::VehicleClass::human, {"north_a_A", "A_B"}, 1, 280.0, 0.0});
        bench.on_road[turner].lane = two_crossings().find_lane(":A_3_0").value();
        const double free_s = openings_s({})[1];
        double opened_s = 0.0;
        watch(bench, 30.0, [&](ActuationBench& b) {
            b.offer(signal_a, traffic::HoldGreen{west}, 2.0);
            if (b.now.value >= leaves_s) b.on_road.erase(turner);
            if (opened_s == 0.0 && b.shown[0][west[1]] == 'G') opened_s = b.now.value;
        });
        ASSERT_LT(free_s, 9.0);
        EXPECT_NEAR(opened_s, leaves_s < 50.0 ? leaves_s + 0.25 : free_s + 6.0, 0.3);
    }
}

TEST(ConformingHold, for_links_that_turn_yellow_shows_them_red_for_less_than_a_second) {
    ActuationBench bench(0.25, {});
    bench.run_until(10.0);
    bench.shown[0] = "yyyyrrrryyyyrrrr";
    const std::vector<Shown> history = watch(bench, 30.0, hold_until(north, 30.0));
    for (const Stretch& run : stretches_of(history, north[1])) {
        if (run.letter == 'r') {
            EXPECT_LT(run.to_s - run.from_s, 1.0) << "those that it conflicts with have been red for long";
        }
    }
    EXPECT_EQ(history.back().state[north[1]], 'G');
}

TEST(ConformingHold, shows_that_it_takes_right_of_way_before_the_others_open) {
    ActuationBench bench(0.25, {});
    double yields_s = 0.0;
    double opens_s = 0.0;
    const traffic::HoldGreen northern{north, {1, 2}};
    const traffic::HoldGreen southern{{8, 9, 10, 11}, {9, 10}};
    watch(bench, 30.0, [&](ActuationBench& b) {
        b.offer(signal_a, northern, 2.0, 0, "policy", core::VehicleKey{1});
        if (b.now.value >= 15.0) b.offer(signal_a, southern, 2.0, 0, "policy", core::VehicleKey{2});
        if (b.now.value > 15.0 && yields_s == 0.0 && b.shown[0][3] == 'g') yields_s = b.now.value;
        if (b.now.value > 15.0 && opens_s == 0.0 && b.shown[0][9] == 'G') opens_s = b.now.value;
    });
    EXPECT_NEAR(yields_s, 15.25, 1e-9);
    EXPECT_NEAR(opens_s - yields_s, 1.5, 0.25 + 1e-9) << "all_red_s";
}

TEST(ConformingHold, with_a_fixed_rule_shows_what_the_settings_say) {
    actuation::ActuatorConfig config = fixed_clearance();
    config.yellow_s = 2.0;
    double shortest_s = 100.0;
    for (const Stretch& run : stretches_of(seesaw(config), north[1])) {
        if (run.letter == 'y') shortest_s = std::min(shortest_s, run.to_s - run.from_s);
    }
    EXPECT_NEAR(shortest_s, 2.0, 0.3) << "the program itself shows 4 s";
}

}  // namespace
}  // namespace clearway::testing
